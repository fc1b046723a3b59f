"""Renders for `tools/bench/peers` with Mitsuba 3: run by the Python that has it.

    peers_mitsuba.py VARIANT THREADS SCENE-FOLDER SAMPLER SIZE
"""

import json
import math
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
import drjit as dr
import mitsuba as mi
import numpy as np

from peers_scene import turned_about
from peers_worker import serve


def colour(values):
    return {"type": "rgb", "value": values}


def bsdf(material):
    """Metal is white: Fresnel 1 (material none). GGX with its visible normals, as elsewhere."""
    if material["kind"] == "glass":
        return {"type": "dielectric", "int_ior": material["ior"], "ext_ior": 1.0}
    if material["kind"] == "mirror":
        inner = {"type": "conductor", "material": "none"}
    elif material["kind"] == "metal":
        inner = {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": material["alpha"]}
    else:
        inner = {"type": "diffuse", "reflectance": colour(material["colour"])}
    return {"type": "twosided", "nested": inner}


def mesh(body, data, properties):
    """A mesh whose vertices need not be written to a file first."""
    def numbers(key, kind):
        start, count = body[key]
        return np.frombuffer(data, kind, count, start)

    positions, indices = numbers("positions", "<f4"), numbers("indices", "<u4")
    smooth = body["normals"] is not None
    props = mi.Properties()
    for key, value in properties.items():
        props[key] = mi.load_dict(value)
    made = mi.Mesh(body["name"], len(positions) // 3, len(indices) // 3, has_vertex_normals=smooth, props=props)
    params = mi.traverse(made)
    params["vertex_positions"], params["faces"] = positions, indices
    if smooth:
        params["vertex_normals"] = numbers("normals", "<f4")
    params.update()
    return made


def shape(body, materials, data):
    material = materials[body["material"]]
    properties = {"bsdf": bsdf(material)}
    if any(material["emission"]):
        properties["emitter"] = {"type": "area", "radiance": colour(material["emission"])}
    if "sphere" in body:
        return {"type": "sphere", "center": body["sphere"]["centre"], "radius": body["sphere"]["radius"], **properties}
    return mesh(body, data, properties)


def sensor(camera, sampler, size):
    matrix = mi.ScalarTransform4f(np.array(turned_about(camera["matrix"])))
    return {"type": "perspective", "fov": math.degrees(camera["yfov"]), "fov_axis": "y", "to_world": matrix,
            "near_clip": 1e-3, "far_clip": 1e4, "sampler": {"type": sampler},
            "film": {"type": "hdrfilm", "width": size, "height": size, "pixel_format": "rgb", "component_format": "float32",
                     "rfilter": {"type": "box"}}}


def load(folder, sampler, size):
    scene, data = json.loads((folder / "scene.json").read_text()), (folder / "scene.bin").read_bytes()
    made = {"type": "scene", "integrator": {"type": "path", "max_depth": -1}, "sensor": sensor(scene["camera"], sampler, size)}
    made |= {f"body {number}": shape(body, scene["materials"], data) for number, body in enumerate(scene["bodies"])}
    return mi.load_dict(made)


def main():
    variant, threads, folder, sampler, size = sys.argv[1:]
    start = time.perf_counter()
    mi.set_variant(variant)
    dr.set_thread_count(int(threads))
    scene = load(pathlib.Path(folder), sampler, int(size))
    loaded = time.perf_counter() - start

    def answer(request):
        """The image in memory is the end of rendering; writing it is not counted."""
        begin = time.perf_counter()
        image = np.array(mi.render(scene, spp=request["spp"], seed=request["seed"]), dtype="<f4")
        seconds = time.perf_counter() - begin
        image[..., :3].tofile(request["out"])
        return {"seconds": seconds, "loadSeconds": loaded, "spp": int(scene.sensors()[0].sampler().sample_count())}

    serve(answer)


if __name__ == "__main__":
    main()
