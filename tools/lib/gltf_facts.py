"""What a glTF file says of itself without being loaded: its size, its first camera's shape, the files it names."""

import json
import pathlib
import struct
import urllib.parse

TRIANGLES, STRIP, FAN = 4, 5, 6


def read_document(path):
    data = pathlib.Path(path).read_bytes()
    if data[:4] == b"glTF":
        length = struct.unpack_from("<I", data, 12)[0]
        data = data[20:20 + length]
    return json.loads(data)


def primitive_triangles(document, primitive):
    accessor = primitive.get("indices", primitive["attributes"]["POSITION"])
    count = document["accessors"][accessor]["count"]
    mode = primitive.get("mode", TRIANGLES)
    return count // 3 if mode == TRIANGLES else max(count - 2, 0) if mode in (STRIP, FAN) else 0


def mesh_triangles(document, index):
    return sum(primitive_triangles(document, primitive) for primitive in document["meshes"][index]["primitives"])


def aspect_ratio(document):
    """Of the first camera, if it is a perspective one that says so."""
    cameras = document.get("cameras", [])
    return cameras[0].get("perspective", {}).get("aspectRatio") if cameras else None


def describe(path):
    document = read_document(path)
    nodes = document.get("nodes", [])
    spheres = [node for node in nodes if "sphere" in (node.get("extras") or {})]
    meshes = [node["mesh"] for node in nodes if "mesh" in node and node not in spheres]
    named = [item.get("uri", "data:") for kind in ("buffers", "images") for item in document.get(kind, [])]
    return {
        "triangles": sum(mesh_triangles(document, mesh) for mesh in meshes),
        "spheres": len(spheres),
        "aspectRatio": aspect_ratio(document),
        "files": [pathlib.Path(path).parent / urllib.parse.unquote(uri) for uri in named if not uri.startswith("data:")],
    }


def facts(path):
    """Triangles and spheres over all nodes, and the files named; all but those are None in a file that is not sound."""
    try:
        return describe(path)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError, struct.error):
        return {"triangles": None, "spheres": None, "aspectRatio": None, "files": []}
