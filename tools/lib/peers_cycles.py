"""Renders for `tools/bench/peers` with Cycles: run by blender -b --factory-startup --python-exit-code 1 --python.

    peers_cycles.py -- THREADS SCENE-FOLDER PATTERN SIZE
"""

import json
import math
import os
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
import bpy
import mathutils

from peers_scene import read_numbers, rectangle
from peers_worker import serve
from study_exr import read_channels

MANY = 1024  # bounces: Cycles' most
BEHIND = 1e-4  # metres between a lamp and the black plate that is its back


def material_for(found):
    """Cycles' roughness is the root of alpha, as glTF's."""
    made = bpy.data.materials.new(found["kind"])
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    if found["kind"] == "glass":
        shader = nodes.new("ShaderNodeBsdfGlass")
        shader.distribution = "SHARP"
        shader.inputs["IOR"].default_value = found["ior"]
    elif found["kind"] in ("mirror", "metal"):
        shader = nodes.new("ShaderNodeBsdfGlossy")
        shader.distribution = "SHARP" if found["kind"] == "mirror" else "GGX"
        shader.inputs["Roughness"].default_value = math.sqrt(found.get("alpha", 0.0))
    else:
        shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = [*found.get("colour", [1.0] * 3), 1.0]
    links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def add_object(name, data):
    item = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(item)
    return item


def add_mesh(name, positions, indices, normals, material):
    mesh = bpy.data.meshes.new(name)
    count = len(indices) // 3
    mesh.vertices.add(len(positions) // 3)
    mesh.vertices.foreach_set("co", positions)
    mesh.loops.add(3 * count)
    mesh.loops.foreach_set("vertex_index", indices)
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", range(0, 3 * count, 3))
    mesh.polygons.foreach_set("loop_total", [3] * count)
    mesh.polygons.foreach_set("use_smooth", [normals is not None] * count)
    mesh.update(calc_edges=True)
    if normals is not None:
        mesh.use_auto_smooth = True
        mesh.normals_split_custom_set_from_vertices([normals[at:at + 3] for at in range(0, len(normals), 3)])
    mesh.materials.append(material)
    item = add_object(name, mesh)
    # Both would move the ends of shadow rays.
    item.cycles.shadow_terminator_offset = item.cycles.shadow_terminator_geometry_offset = 0.0


def add_lamp(name, corner, u, v, radiance):
    """An area light shines along its -z; its radiance is a quarter of its power over its area."""
    x, y = mathutils.Vector(u), mathutils.Vector(v)
    light = bpy.data.lights.new(name, "AREA")
    light.shape = "RECTANGLE"
    light.size, light.size_y = x.length, y.length
    strongest = max(radiance)
    light.color = [value / strongest for value in radiance]
    light.energy = 4.0 * x.length * y.length * strongest
    light.cycles.max_bounces = MANY
    light.cycles.use_multiple_importance_sampling = True
    normal = x.cross(y).normalized()
    matrix = mathutils.Matrix((-x.normalized(), y.normalized(), -normal)).transposed().to_4x4()
    matrix.translation = mathutils.Vector(corner) + 0.5 * (x + y)
    item = add_object(name, light)
    item.matrix_world = matrix
    item.visible_camera = True  # lights are born without
    return normal


def add_body(body, found, material, data):
    positions, indices = read_numbers(data, body["positions"], "f"), read_numbers(data, body["indices"], "I")
    normals = body["normals"] and read_numbers(data, body["normals"], "f")
    if any(found["emission"]):
        shape = rectangle(positions, indices)
        if shape is None:
            raise ValueError(f"lamp '{body['name']}' is no rectangle")
        normal = add_lamp(body["name"], *shape, found["emission"])
        for at, value in enumerate(positions):
            positions[at] = value - BEHIND * normal[at % 3]
    add_mesh(body["name"], positions, indices, normals, material)


def add_camera(found):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle_y = found["yfov"]
    camera.clip_start, camera.clip_end = 1e-3, 1e4
    item = add_object("camera", camera)
    item.matrix_world = mathutils.Matrix(found["matrix"])
    bpy.context.scene.camera = item


def set_up_rendering(threads, pattern, size):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", threads
    scene.render.use_persistent_data = True
    scene.render.use_compositing = scene.render.use_sequencer = False
    image = scene.render.image_settings
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGB", "32", "NONE"
    scene.view_settings.view_transform = "Raw"
    scene.display_settings.display_device = "None"
    scene.world = None
    wanted = {"device": "CPU", "sampling_pattern": pattern, "pixel_filter_type": "BOX", "film_exposure": 1.0,
              "use_adaptive_sampling": False, "use_denoising": False, "sample_clamp_direct": 0.0, "sample_clamp_indirect": 0.0,
              "blur_glossy": 0.0, "caustics_reflective": True, "caustics_refractive": True, "use_fast_gi": False,
              "max_bounces": MANY, "diffuse_bounces": MANY, "glossy_bounces": MANY, "transmission_bounces": MANY,
              "transparent_max_bounces": MANY, "use_guiding": False, "auto_scrambling_distance": False}
    for name, value in wanted.items():
        setattr(scene.cycles, name, value)


def load(folder):
    found, data = json.loads((folder / "scene.json").read_text()), (folder / "scene.bin").read_bytes()
    materials = [material_for(item) for item in found["materials"]]
    for body in found["bodies"]:
        add_body(body, found["materials"][body["material"]], materials[body["material"]], data)
    add_camera(found["camera"])


def main():
    threads, folder, pattern, size = sys.argv[sys.argv.index("--") + 1:]
    start = time.perf_counter()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    set_up_rendering(int(threads), pattern, int(size))
    load(pathlib.Path(folder))
    loaded = time.perf_counter() - start

    def answer(request):
        cycles = bpy.context.scene.cycles
        cycles.samples, cycles.seed = request["spp"], request["seed"]
        bpy.context.scene.update_tag()  # else persistent data keeps both as they were
        begin = time.perf_counter()
        bpy.ops.render.render()
        seconds = time.perf_counter() - begin
        path = request["out"] + ".exr"
        bpy.data.images["Render Result"].save_render(path)
        _, _, pixels = read_channels(path, ["R", "G", "B"])
        os.remove(path)
        values = [value for pixel in zip(pixels["R"], pixels["G"], pixels["B"]) for value in pixel]
        type(pixels["R"])("f", values).tofile(open(request["out"], "wb"))
        return {"seconds": seconds, "loadSeconds": loaded, "spp": request["spp"]}

    serve(answer)


main()
