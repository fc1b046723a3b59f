#!/usr/bin/env python3
"""Writes the seeds of the loader's fuzzer into a folder: small valid files that between them have every feature.

  make_corpus.py FOLDER

Scenes as .gltf and .glb, images and environment maps. oiiotool, of OpenImageIO's tools, encodes the pictures; those that
it cannot write are left out.
"""
import base64
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

BYTE, UBYTE, SHORT, USHORT, UINT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
CODES = {BYTE: "b", UBYTE: "B", SHORT: "h", USHORT: "H", UINT: "I", FLOAT: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def data_uri(media_type, data):
    return f"data:{media_type};base64," + base64.b64encode(data).decode()


class Gltf:
    """A document in the making, with one buffer."""

    def __init__(self, **members):
        self.doc = {"asset": {"version": "2.0"}, **members}
        self.data = bytearray()

    def add(self, kind, item):
        self.doc.setdefault(kind, []).append(item)
        return len(self.doc[kind]) - 1

    def view(self, data, **members):
        self.data += bytes(-len(self.data) % 4)
        offset = len(self.data)
        self.data += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(data), **members})

    def accessor(self, kind, component, values, **members):
        data = struct.pack(f"<{len(values)}{CODES[component]}", *values)
        return self.add("accessors", {"bufferView": self.view(data), "componentType": component, "type": kind,
                                      "count": len(values) // WIDTHS[kind], **members})

    def text(self):
        if self.data:
            uri = data_uri("application/octet-stream", bytes(self.data))
            self.doc["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        return json.dumps(self.doc, separators=(",", ":")).encode()

    def glb(self):
        if self.data:
            self.doc["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.doc, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        if self.data:
            binary = bytes(self.data) + bytes(-len(self.data) % 4)
            chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


TRIANGLE = (0, 0, 0, 1, 0, 0, 0, 1, 0)
QUAD = (0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0)
UVS = (0, 0, 1, 0, 1, 1, 0, 1)


def triangle():
    g = Gltf()
    g.add("meshes", {"primitives": [{"attributes": {"POSITION": g.accessor("VEC3", FLOAT, TRIANGLE)}}]})
    g.add("nodes", {"mesh": 0})
    return g


def attributes():
    """Every attribute, indices of every width, strips and fans, morph targets."""
    g = Gltf(scene=0, scenes=[{"name": "s", "nodes": [0]}])
    position = g.accessor("VEC3", FLOAT, QUAD)
    mesh = {"POSITION": position, "NORMAL": g.accessor("VEC3", FLOAT, (0, 0, 1) * 4),
            "TANGENT": g.accessor("VEC4", FLOAT, (1, 0, 0, 1) * 4),
            "TEXCOORD_0": g.accessor("VEC2", FLOAT, UVS), "COLOR_0": g.accessor("VEC4", FLOAT, (1, .5, .2, 1) * 4)}
    primitives = []
    for mode, component, indices in ((4, UBYTE, (0, 1, 2, 0, 2, 3)), (5, USHORT, (0, 1, 3, 2)), (6, UINT, (0, 1, 2, 3))):
        primitives.append({"attributes": mesh, "indices": g.accessor("SCALAR", component, indices), "mode": mode})
    primitives[0]["targets"] = [{"POSITION": position}]
    g.add("meshes", {"name": "m", "primitives": primitives})
    g.add("nodes", {"mesh": 0, "children": [1], "translation": [1, 2, 3], "rotation": [0, 0, 0, 1], "scale": [1, -2, 1]})
    g.add("nodes", {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]})
    return g


def quantised():
    g = Gltf(extensionsUsed=["KHR_mesh_quantization"], extensionsRequired=["KHR_mesh_quantization"])
    view = g.view(struct.pack("<12h", 0, 0, 0, 0, 9, 0, 0, 0, 0, 9, 0, 0), byteStride=8)
    g.add("accessors", {"bufferView": view, "componentType": SHORT, "type": "VEC3", "count": 3, "normalized": True})
    view = g.view(struct.pack("<12b", *(0, 0, 127, 0) * 3), byteStride=4)
    g.add("accessors", {"bufferView": view, "componentType": BYTE, "type": "VEC3", "count": 3, "normalized": True})
    uv = g.accessor("VEC2", USHORT, (0, 0, 65535, 0, 0, 65535), normalized=True)
    g.add("meshes", {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": uv}}]})
    g.add("nodes", {"mesh": 0})
    return g


def sparse():
    g = Gltf()
    indices = g.view(struct.pack("<2H", 1, 2))
    values = g.view(struct.pack("<6f", 1, 0, 0, 0, 1, 0))
    part = {"count": 2, "indices": {"bufferView": indices, "componentType": USHORT}, "values": {"bufferView": values}}
    position = g.add("accessors", {"componentType": FLOAT, "type": "VEC3", "count": 3, "sparse": part})
    based = g.accessor("VEC3", FLOAT, TRIANGLE, sparse=part)
    for accessor in (position, based):
        g.add("meshes", {"primitives": [{"attributes": {"POSITION": accessor}}]})
        g.add("nodes", {"mesh": accessor})
    return g


def texture_info(index, **transform):
    info = {"index": index, "texCoord": 0}
    if transform:
        info["extensions"] = {"KHR_texture_transform": transform}
    return info


def materials(image, webp):
    """Every map and extension of materials."""
    names = ("emissive_strength", "ior", "specular", "transmission", "unlit", "volume")
    g = Gltf(extensionsUsed=["KHR_materials_" + n for n in names] + ["KHR_texture_transform", "EXT_texture_webp"])
    attributes = {"POSITION": g.accessor("VEC3", FLOAT, QUAD), "TEXCOORD_0": g.accessor("VEC2", FLOAT, UVS)}
    indices = g.accessor("SCALAR", UBYTE, (0, 1, 2, 0, 2, 3))
    g.add("images", {"uri": data_uri("image/png", image), "name": "i"})
    g.add("images", {"bufferView": g.view(webp or image), "mimeType": "image/webp"})
    g.add("samplers", {"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9987})
    g.add("textures", {"source": 0, "sampler": 0})
    g.add("textures", {"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}})
    moved = {"offset": [.5, .25], "rotation": .3, "scale": [2, -1], "texCoord": 0}
    core = {"baseColorFactor": [1, .5, .2, .7], "metallicFactor": .5, "roughnessFactor": .3,
            "baseColorTexture": texture_info(0, **moved), "metallicRoughnessTexture": texture_info(1)}
    extended = {"KHR_materials_ior": {"ior": 1.4}, "KHR_materials_emissive_strength": {"emissiveStrength": 5},
                "KHR_materials_specular": {"specularFactor": .5, "specularTexture": texture_info(0),
                                           "specularColorFactor": [1, 1, .5], "specularColorTexture": texture_info(0)},
                "KHR_materials_transmission": {"transmissionFactor": .9, "transmissionTexture": texture_info(0)},
                "KHR_materials_volume": {"thicknessFactor": 1, "thicknessTexture": texture_info(0),
                                         "attenuationDistance": 2, "attenuationColor": [.5, 1, 1]}}
    kinds = [{"pbrMetallicRoughness": core, "normalTexture": {"index": 0, "scale": .5},
              "occlusionTexture": {"index": 0, "strength": 1}, "emissiveTexture": texture_info(1),
              "emissiveFactor": [1, 1, 0], "doubleSided": True, "alphaMode": "BLEND"},
             {"name": "glass", "extensions": extended}, {"alphaMode": "MASK", "alphaCutoff": .3},
             {"pbrMetallicRoughness": core, "extensions": {"KHR_materials_unlit": {}}}]
    primitives = [{"attributes": attributes, "indices": indices, "material": g.add("materials", kind)} for kind in kinds]
    g.add("meshes", {"primitives": primitives})
    g.add("nodes", {"mesh": 0})
    return g


def placements():
    """Cameras, lights, spheres, a sky, several scenes."""
    lights = [{"type": "point", "color": [1, .5, 0], "intensity": 3, "range": 5}, {"type": "directional", "name": "sun"},
              {"type": "spot", "spot": {"innerConeAngle": .1, "outerConeAngle": .5}}]
    sky = {"cgl_hemisphere_light": {"radiance": [1, 1, 2], "up": [0, 1, 0]}}
    g = Gltf(extensionsUsed=["KHR_lights_punctual"], extensions={"KHR_lights_punctual": {"lights": lights}}, scene=1,
             scenes=[{"nodes": [0]}, {"name": "second", "nodes": [0, 3], "extras": sky}])
    g.add("cameras", {"type": "perspective", "perspective": {"yfov": .8, "aspectRatio": 1.5, "znear": .1, "zfar": 100}})
    g.add("cameras", {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1, "znear": 0, "zfar": 9}})
    g.add("materials", {"name": "red", "emissiveFactor": [1, 0, 0]})
    for i in range(3):
        node = {"extensions": {"KHR_lights_punctual": {"light": i}}, "extras": {"sphere": {"radius": .5, "material": 0}}}
        if i < 2:
            node.update(camera=i, children=[i + 1])
        g.add("nodes", node)
    g.add("nodes", {"name": "last", "skin": 0, "scale": [2, 2, 2]})
    g.add("skins", {"joints": [3], "skeleton": 3})
    g.add("animations", {"channels": [{"sampler": 0, "target": {"node": 3, "path": "scale"}}], "samplers": [{}]})
    return g


def pictures(folder):
    """file name -> bytes; one for each format, depth and number of channels."""
    wanted = {f"{name}.{suffix}": f"{size} {channels} -d {depth}" for name, channels, depth in
              (("rgb", 3, "uint8"), ("rgba", 4, "uint8"), ("grey", 1, "uint8"), ("deep", 4, "uint16"),
               ("float", 3, "float"), ("half", 4, "half"))
              for size in ("5x4",)
              for suffix in {"uint8": ("png", "jpg", "webp"), "uint16": ("png",), "float": ("hdr", "exr"),
                             "half": ("exr",)}[depth]}
    for compression in ("none", "rle", "zip", "piz", "pxr24", "b44", "dwaa"):
        wanted[f"{compression}.exr"] = f"5x4 3 -d half --compression {compression}"
    made = {}
    for name, options in wanted.items():
        size, channels, *rest = options.split()
        pattern = ["--pattern", "fill:topleft=0.1,0.9,0.3,1:bottomright=0.8,0.2,0.5,0.2", size, channels]
        command = ["oiiotool", *pattern, *rest, "-o", str(folder / name)]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        if done.returncode == 0:
            made[name] = (folder / name).read_bytes()
    return made


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 0 if sys.argv[1:] in (["-h"], ["--help"]) else 2
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        files = pictures(pathlib.Path(scratch))
    if "rgb.png" not in files:
        print("oiiotool makes no PNG", file=sys.stderr)
        return 1
    textured = (files["rgb.png"], files.get("rgba.webp"))
    for name, make in (("triangle", triangle), ("attributes", attributes), ("quantised", quantised), ("sparse", sparse),
                       ("materials", lambda: materials(*textured)), ("placements", placements)):
        files[f"{name}.gltf"], files[f"{name}.glb"] = make().text(), make().glb()
    for name, data in files.items():
        (folder / name).write_bytes(data)
    return 0


if __name__ == "__main__":
    sys.exit(main())
