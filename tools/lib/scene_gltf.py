"""A glTF document in the making, and its files: the same byte for byte on every machine."""

import base64
import json
import struct

FLOAT, USHORT, UINT = 5126, 5123, 5125


class Gltf:
    """A glTF document in the making, with one buffer."""

    def __init__(self, name):
        self.doc = {
            "asset": {"version": "2.0", "generator": "isolux tools/make_scenes", "copyright": "CC0 1.0"},
            "extensionsUsed": [],
            "scene": 0,
            "scenes": [{"name": name, "nodes": []}],
        }
        self.data = bytearray()

    def use(self, extension):
        self.doc["extensionsUsed"] = sorted({*self.doc["extensionsUsed"], extension})

    def add(self, kind, item):
        items = self.doc.setdefault(kind, [])
        items.append(item)
        return len(items) - 1

    def accessor(self, values, component, width):
        """Appends numbers as an accessor of vectors of `width` components."""
        code = {FLOAT: "f", USHORT: "H", UINT: "I"}[component]
        packed = struct.pack(f"<{len(values)}{code}", *values)
        item = {"bufferView": self.view(packed), "componentType": component, "count": len(values) // width,
                "type": {1: "SCALAR", 2: "VEC2", 3: "VEC3"}[width]}
        if component == FLOAT:
            stored = struct.unpack(f"<{len(values)}f", packed)
            item["min"] = [min(stored[axis::width]) for axis in range(width)]
            item["max"] = [max(stored[axis::width]) for axis in range(width)]
        return self.add("accessors", item)

    def view(self, packed):
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        self.data += packed + b"\0" * (-len(packed) % 4)
        return view

    def indices(self, values):
        return self.accessor(values, USHORT if max(values) < 0xFFFF else UINT, 1)

    def material(self, name, colour, emission=(0.0, 0.0, 0.0), strength=1.0):
        """A Lambertian surface: no metal, no specular reflection."""
        item = {"name": name,
                "pbrMetallicRoughness": {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0},
                "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}}}
        self.use("KHR_materials_specular")
        if any(emission):
            item["emissiveFactor"] = list(emission)
        if strength != 1.0:
            item["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
            self.use("KHR_materials_emissive_strength")
        return self.add("materials", item)

    def surface(self, name, metallic, roughness, extensions=(), **members):
        """Any other surface: of pbrMetallicRoughness the members that start with `base`, and further ones as they are."""
        pbr = {key: value for key, value in members.items() if key.startswith("base")}
        item = {"name": name, "pbrMetallicRoughness": {**pbr, "metallicFactor": metallic, "roughnessFactor": roughness}}
        item |= {key: value for key, value in members.items() if key not in pbr}
        if extensions:
            item["extensions"] = {f"KHR_materials_{key}": value for key, value in dict(extensions).items()}
        for extension in item.get("extensions", {}):
            self.use(extension)
        return self.add("materials", item)

    def texture(self, name, png, **sampler):
        image = self.add("images", {"name": name, "mimeType": "image/png", "bufferView": self.view(png)})
        members = {"source": image}
        if sampler:
            members["sampler"] = self.add("samplers", sampler)
        return {"index": self.add("textures", members)}

    def mesh(self, name, material, attributes, indices):
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def quads(self, name, material, quads, corners=()):
        """Quadrilaterals, each given by its corners, counter-clockwise seen from the front; `corners` are the texture
        coordinates of each one's corners, if it has any."""
        points = [coordinate for quad in quads for corner in quad for coordinate in corner]
        indices = [4 * i + k for i in range(len(quads)) for k in (0, 1, 2, 0, 2, 3)]
        attributes = {"POSITION": self.accessor(points, FLOAT, 3)}
        if corners:
            attributes["TEXCOORD_0"] = self.accessor([c for _ in quads for corner in corners for c in corner], FLOAT, 2)
        return self.mesh(name, material, attributes, self.indices(indices))

    def node(self, name, **members):
        self.doc["scenes"][0]["nodes"].append(self.add("nodes", {"name": name, **members}))

    def camera(self, name, yfov, **placement):
        camera = self.add("cameras", {"name": name, "type": "perspective",
                                      "perspective": {"aspectRatio": 1.0, "yfov": yfov, "znear": 0.01}})
        self.node(name, camera=camera, **placement)

    def orthographic(self, name, half_width, half_height, **placement):
        camera = self.add("cameras", {"name": name, "type": "orthographic", "orthographic": {
            "xmag": half_width, "ymag": half_height, "znear": 0.01, "zfar": 100.0}})
        self.node(name, camera=camera, **placement)

    def light(self, name, kind, colour, intensity, placement, **members):
        """A punctual light: point and spot in W/sr, directional in W/m^2."""
        lights = self.doc.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"name": name, "type": kind, "color": list(colour), "intensity": intensity, **members})
        self.use("KHR_lights_punctual")
        self.node(name, extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **placement)

    def to_gltf(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.doc["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        return (layout(self.doc) + "\n").encode()

    def to_glb(self):
        self.doc["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.doc, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(self.data), b"BIN\0") + self.data
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def layout(value, indent=0):
    """JSON with whatever fits on a line on one line."""
    flat = json.dumps(value)
    if len(flat) + indent <= 110 or not isinstance(value, (dict, list)):
        return flat
    pad = " " * (indent + 2)
    if isinstance(value, dict):
        parts = [f"{pad}{json.dumps(key)}: {layout(item, indent + 2)}" for key, item in value.items()]
    else:
        parts = [pad + layout(item, indent + 2) for item in value]
    opening, closing = "{}" if isinstance(value, dict) else "[]"
    return opening + "\n" + ",\n".join(parts) + "\n" + " " * indent + closing
