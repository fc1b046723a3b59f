"""Small images for the project's scenes, as PNG files without compression: the same byte for byte on every machine."""

import math
import struct
import zlib

RGB, RGBA = 2, 6  # PNG's colour types


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def stored(data):
    """A zlib stream of blocks that are not compressed (RFC 1950, RFC 1951 3.2.4): compressors differ in what they make."""
    blocks = [data[start:start + 0xFFFF] for start in range(0, len(data), 0xFFFF)]
    packed = b"".join(struct.pack("<BHH", number + 1 == len(blocks), len(block), len(block) ^ 0xFFFF) + block
                      for number, block in enumerate(blocks))
    return b"\x78\x01" + packed + struct.pack(">I", zlib.adler32(data))


def png(width, height, colour_type, texel):
    """`texel` gives the channels' codes, from 0 to 255, by column and row from the top."""
    rows = b"".join(b"\0" + bytes(code for x in range(width) for code in texel(x, y)) for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", stored(rows)) + chunk(b"IEND", b"")


def grain(x, y):
    """A number in [0, 1) that looks random."""
    h = (x * 374761393 + y * 668265263) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return (h ^ (h >> 16)) / 2.0**32


def tiles(size):
    """Four tiles of two colours with joints between them."""
    colours = [(196, 186, 170), (118, 128, 138)]
    half = size // 2

    def texel(x, y):
        if x % half < 2 or y % half < 2:
            return 70, 66, 62
        shade = 0.94 + 0.06 * grain(x, y)
        return tuple(int(code * shade) for code in colours[(x // half + y // half) % 2])

    return png(size, size, RGB, texel)


def bumps(size, count, steepness):
    """A normal map of `count` by `count` round bumps."""
    cell = size // count

    def texel(x, y):
        u, v = ((x % cell) + 0.5) / cell * 2 - 1, ((y % cell) + 0.5) / cell * 2 - 1
        r = math.hypot(u, v)
        slope = steepness * math.sin(math.pi * r) if r < 1 else 0.0
        # Rows run down, the second texture coordinate's tangent up.
        normal = (slope * u / r, -slope * v / r, 1.0) if r > 0 else (0.0, 0.0, 1.0)
        length = math.sqrt(sum(c * c for c in normal))
        return tuple(int(127.5 + 127.5 * c / length + 0.5) for c in normal)

    return png(size, size, RGB, texel)


def lattice(size, bars):
    """Diagonal bars, opaque; nothing between them."""
    step = size // bars

    def texel(x, y):
        edge = x < 4 or y < 4 or x >= size - 4 or y >= size - 4
        bar = (x + y) % step < step // 3 or (x - y) % step < step // 3
        return 205, 160, 90, 255 if edge or bar else 0

    return png(size, size, RGBA, texel)


LETTERS = {"I": "111 010 010 010 111", "S": "111 100 111 001 111", "O": "111 101 101 101 111", "L": "100 100 100 100 111",
           "U": "101 101 101 101 111", "X": "101 101 010 101 101"}


def sign(word, scale):
    """A word in letters of three by five dots, warm on dark, with a thin frame."""
    columns = [[row[x] == "1" for row in LETTERS[letter].split()] for letter in word for x in range(3)]
    dots = {(4 * (i // 3) + i % 3 + 2, y + 2) for i, column in enumerate(columns) for y, on in enumerate(column) if on}
    width, height = 4 * len(word) + 3, 9

    def texel(x, y):
        dot = x // scale, y // scale
        framed = x < 2 or y < 2 or x >= width * scale - 2 or y >= height * scale - 2
        return (255, 196, 120) if dot in dots else (60, 130, 255) if framed else (4, 5, 9)

    return png(width * scale, height * scale, RGB, texel)
