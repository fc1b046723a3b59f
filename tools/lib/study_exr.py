"""Reads channels of the OpenEXR files that the program writes: scan lines of 32-bit floats, plain or zip compressed."""

import array
import itertools
import pathlib
import struct
import sys
import zlib

MAGIC = b"v/1\x01"
FLOAT = 2
LINES_OF = {0: 1, 2: 1, 3: 16}  # compression: scan lines a block
PLAIN = 0


def read_name(data, start):
    end = data.index(b"\0", start)
    return data[start:end].decode("latin-1"), end + 1


def read_header(data):
    """Attributes by name, and where the header ends. A channel's and a file's lists end with an empty name."""
    if data[:4] != MAGIC:
        raise ValueError("not an OpenEXR file")
    attributes, at = {}, 8
    while data[at]:
        name, at = read_name(data, at)
        _, at = read_name(data, at)
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channel_names(listing):
    names, at = [], 0
    while listing[at]:
        name, at = read_name(listing, at)
        if struct.unpack_from("<i", listing, at)[0] != FLOAT:
            raise ValueError(f"channel {name} does not hold floats")
        names.append(name)
        at += 16
    return names


def unpacked(block, size):
    """What was compressed: differences of bytes, even and odd bytes apart; a block that would have grown is plain."""
    if len(block) == size:
        return block
    data = zlib.decompress(block)
    sums = bytes(value & 255 for value in itertools.accumulate(data, lambda a, b: a + b - 128))
    half = (size + 1) // 2
    whole = bytearray(size)
    whole[0::2], whole[1::2] = sums[:half], sums[half:]
    return bytes(whole)


def read_channels(path, wanted):
    """Width, height and the pixels of each channel wanted, row by row."""
    data = pathlib.Path(path).read_bytes()
    attributes, at = read_header(data)
    names = channel_names(attributes["channels"])
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    compression = attributes["compression"][0]
    lines = LINES_OF[compression]
    offsets = struct.unpack_from(f"<{-(-height // lines)}Q", data, at)
    pixels = {name: array.array("f") for name in wanted}
    for number, offset in enumerate(offsets):
        rows = min(lines, height - number * lines)
        length, = struct.unpack_from("<i", data, offset + 4)
        size = rows * width * 4 * len(names)
        block = data[offset + 8:offset + 8 + length]
        append_rows(pixels, names, width, block if compression == PLAIN else unpacked(block, size))
    return width, height, pixels


def append_rows(pixels, names, width, block):
    """Each row of a block holds the channels one after another."""
    for row in range(0, len(block), 4 * width * len(names)):
        for number, name in enumerate(names):
            if name in pixels:
                start = row + 4 * width * number
                pixels[name].frombytes(block[start:start + 4 * width])


def luminance(pixels):
    """Of linear Rec. 709 (ITU-R BT.709)."""
    return [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(pixels["R"], pixels["G"], pixels["B"])]


assert sys.byteorder == "little", "OpenEXR's numbers are read as they are stored"
