"""Writes a glTF scene as what every renderer of `tools/bench/peers` is given: one list of bodies in world space, with
materials that all of them have the same idea of. A folder holds scene.json, and scene.bin with the numbers."""

import array
import base64
import json
import math
import pathlib
import struct

from gltf_facts import read_document
from scene_shapes import geodesic

FORMATS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
MIRROR_ALPHA = 1e-5  # below it a reflection is a perfect mirror's (host/scene/README.md, delta lobes)
# Triangles of a sphere for renderers without exact ones: 20 times its square. Chords lie within 2.5e-5 of the radius.
SPHERE_FREQUENCY = 64


class Unsupported(Exception):
    """The scene holds what the renderers do not have alike; the message is one line."""


# --- matrices: four rows of four numbers

def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def rotation(x, y, z, w):
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0.0],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0.0],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0.0],
            [0.0, 0.0, 0.0, 1.0]]


def node_matrix(node):
    """glTF 2.0, 3.5.3: translation times rotation times scale, or a matrix by columns."""
    if "matrix" in node:
        return [node["matrix"][row::4] for row in range(4)]
    matrix = rotation(*node.get("rotation", (0.0, 0.0, 0.0, 1.0)))
    for row, offset in zip(matrix, node.get("translation", (0.0, 0.0, 0.0))):
        row[:] = [value * factor for value, factor in zip(row, node.get("scale", (1.0, 1.0, 1.0)))] + [offset]
    return matrix


def cofactors(m):
    """Of the linear part: the determinant times its inverse transpose, which turns normals."""
    def minor(i, j):
        a, b = (i + 1) % 3, (i + 2) % 3
        c, d = (j + 1) % 3, (j + 2) % 3
        return m[a][c] * m[b][d] - m[a][d] * m[b][c]
    return [[minor(i, j) for j in range(3)] for i in range(3)]


def determinant(m):
    return sum(a * b for a, b in zip(m[0][:3], cofactors(m)[0]))


def turned_about(matrix):
    """The camera looking along +z with x to the left, which is Mitsuba's, for one that looks along -z with x to the right."""
    return [[-row[0], row[1], -row[2], row[3]] for row in matrix]


# --- what a file holds

def buffer_bytes(path, document):
    data = pathlib.Path(path).read_bytes()
    if data[:4] == b"glTF":
        start = 20 + struct.unpack_from("<I", data, 12)[0]
        return data[start + 8:start + 8 + struct.unpack_from("<I", data, start)[0]]
    uri = document["buffers"][0]["uri"]
    return base64.b64decode(uri.split(",", 1)[1]) if uri.startswith("data:") else (path.parent / uri).read_bytes()


def accessor(document, data, index):
    item = document["accessors"][index]
    view = document["bufferViews"][item["bufferView"]]
    code, width = FORMATS[item["componentType"]], WIDTHS[item["type"]]
    if view.get("byteStride", width * struct.calcsize(code)) != width * struct.calcsize(code) or "sparse" in item:
        raise Unsupported("interleaved or sparse accessors are not read here")
    start = view.get("byteOffset", 0) + item.get("byteOffset", 0)
    return struct.unpack_from(f"<{item['count'] * width}{code}", data, start)


def extension(item, name):
    return item.get("extensions", {}).get(f"KHR_materials_{name}", {})


def emission(material):
    strength = extension(material, "emissive_strength").get("emissiveStrength", 1.0)
    return [factor * strength for factor in material.get("emissiveFactor", [0.0, 0.0, 0.0])]


def scattering(material):
    """Kind and parameters, where all renderers agree on them."""
    pbr = material.get("pbrMetallicRoughness", {})
    colour = pbr.get("baseColorFactor", [1.0] * 4)[:3]
    roughness, metallic = pbr.get("roughnessFactor", 1.0), pbr.get("metallicFactor", 1.0)
    if extension(material, "transmission").get("transmissionFactor", 0.0) == 1.0:
        if roughness != 0.0 or colour != [1.0] * 3 or not extension(material, "volume").get("thicknessFactor", 0.0):
            raise Unsupported("glass must be smooth, clear and solid")
        return {"kind": "glass", "ior": extension(material, "ior").get("ior", 1.5)}
    if metallic == 1.0:
        if colour != [1.0] * 3:
            raise Unsupported("metal must be white: coloured ones differ in their Fresnel terms")
        alpha = roughness * roughness
        return {"kind": "mirror"} if alpha < MIRROR_ALPHA else {"kind": "metal", "alpha": alpha}
    if metallic != 0.0 or extension(material, "specular").get("specularFactor", 1.0) != 0.0:
        raise Unsupported("a surface must be Lambertian, white metal or glass")
    return {"kind": "diffuse", "colour": colour}


def material_of(material):
    """Raises Unsupported if it is not the same in all renderers."""
    try:
        if "Texture" in json.dumps(material) or material.get("alphaMode", "OPAQUE") != "OPAQUE":
            raise Unsupported("maps and alpha are not compared here")
        found = scattering(material)
        found["emission"] = emission(material)
        if any(found["emission"]) and (material.get("doubleSided") or found.get("colour") != [0.0] * 3):
            raise Unsupported("a lamp must be black and give light from its front alone")
        return found
    except Unsupported as error:
        raise Unsupported(f"material '{material.get('name', '')}': {error}") from None


def placed(document):
    """Every node with the matrix from its space to the world."""
    todo = [(index, [[float(i == j) for j in range(4)] for i in range(4)])
            for index in document["scenes"][document.get("scene", 0)]["nodes"]]
    for index, parent in todo:
        node = document["nodes"][index]
        matrix = product(parent, node_matrix(node))
        yield node, matrix
        todo += [(child, matrix) for child in node.get("children", [])]


# --- bodies

def moved(points, matrix):
    """Numbers of points, three each, brought to the world."""
    out = array.array("f")
    (a, b, c, d), (e, f, g, h), (i, j, k, l) = matrix[:3]
    for x, y, z in zip(points[0::3], points[1::3], points[2::3]):
        out.extend((a * x + b * y + c * z + d, e * x + f * y + g * z + h, i * x + j * y + k * z + l))
    return out


def turned(normals, matrix):
    """Normals brought to the world, unit length."""
    sign = math.copysign(1.0, determinant(matrix))
    rows = [[sign * value for value in row] + [0.0] for row in cofactors(matrix)]
    out = moved(normals, rows)
    for at in range(0, len(out), 3):
        length = math.hypot(*out[at:at + 3]) or 1.0
        out[at:at + 3] = array.array("f", [value / length for value in out[at:at + 3]])
    return out


def facing(indices, matrix):
    """A mirrored mesh runs the other way round (glTF 2.0, 3.7.4)."""
    if determinant(matrix) > 0:
        return array.array("I", indices)
    out = array.array("I", indices)
    out[1::3], out[2::3] = out[2::3], out[1::3]
    return out


class Numbers:
    """The bytes of scene.bin; what is written is named by where it starts and how many numbers it has."""

    def __init__(self):
        self.data = bytearray()

    def add(self, values):
        place = [len(self.data), len(values)]
        self.data += values.tobytes()
        return place

    def add_sphere(self, centre, radius):
        points, triangles = geodesic(SPHERE_FREQUENCY)
        normals = array.array("f", [value for point in points for value in point])
        matrix = [[radius if i == j else 0.0 for j in range(3)] + [centre[i]] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]
        return {"positions": self.add(moved(normals, matrix)), "normals": self.add(normals),
                "indices": self.add(array.array("I", [corner for triangle in triangles for corner in triangle]))}


def mesh_body(document, data, primitive, matrix, numbers):
    attributes = primitive["attributes"]
    positions = accessor(document, data, attributes["POSITION"])
    indices = accessor(document, data, primitive["indices"]) if "indices" in primitive else range(len(positions) // 3)
    normals = attributes.get("NORMAL")
    return {"positions": numbers.add(moved(positions, matrix)), "indices": numbers.add(facing(indices, matrix)),
            "normals": None if normals is None else numbers.add(turned(accessor(document, data, normals), matrix))}


def sphere_body(node, matrix, numbers):
    """An exact sphere, with a mesh for renderers that have none."""
    centre = [row[3] for row in matrix[:3]]
    radius = node["extras"]["sphere"]["radius"] * abs(determinant(matrix)) ** (1 / 3)
    return {"sphere": {"centre": centre, "radius": radius}, **numbers.add_sphere(centre, radius)}


def bodies(document, data, numbers):
    for node, matrix in placed(document):
        if "mesh" not in node:
            continue
        for primitive in document["meshes"][node["mesh"]]["primitives"]:
            exact = "sphere" in node.get("extras", {})
            body = sphere_body(node, matrix, numbers) if exact else mesh_body(document, data, primitive, matrix, numbers)
            yield {"name": node.get("name", "body"), "material": primitive["material"], **body}


def camera(document):
    for node, matrix in placed(document):
        if "camera" in node:
            found = document["cameras"][node["camera"]]
            if found["type"] != "perspective":
                raise Unsupported("the first camera must be a perspective one")
            return {"matrix": matrix, "yfov": found["perspective"]["yfov"]}
    raise Unsupported("no camera")


def export(path, folder):
    """Writes scene.json and scene.bin into the folder. Raises Unsupported."""
    document = read_document(path)
    extras = document["scenes"][document.get("scene", 0)].get("extras", {})
    if "KHR_lights_punctual" in document.get("extensionsUsed", []) or "cgl_hemisphere_light" in extras:
        raise Unsupported("light must come from surfaces")
    data, numbers = buffer_bytes(path, document), Numbers()
    scene = {"camera": camera(document), "materials": [material_of(item) for item in document["materials"]],
             "bodies": list(bodies(document, data, numbers))}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.bin").write_bytes(numbers.data)
    (folder / "scene.json").write_text(json.dumps(scene, indent=1) + "\n")


def read_numbers(data, place, code):
    """What a place of scene.bin holds."""
    start, count = place
    return array.array(code, data[start:start + 4 * count])


def rectangle(positions, indices):
    """Corner and two edges of a mesh of two triangles that form one, counter-clockwise seen from the front; None if it is
    something else."""
    if len(indices) != 6 or len(positions) != 12:
        return None
    a, b, c, d = (positions[at:at + 3] for at in range(0, 12, 3))
    if list(indices) != [0, 1, 2, 0, 2, 3]:
        return None
    u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, d)]
    size = math.dist(a, c)
    gap = max(abs(p + q + r - s) for p, q, r, s in zip(a, u, v, c))
    cosine = abs(sum(x * y for x, y in zip(u, v))) / (math.hypot(*u) * math.hypot(*v))
    return (list(a), u, v) if gap < 1e-5 * size and cosine < 1e-5 else None
