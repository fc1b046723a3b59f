"""Opens the file of write_layers.cpp in Blender: every layer must be there with its values, and "cube" be found by name."""

import math
import os
import sys
import tempfile

import bpy

PIXELS = 8
CUBE = [0.0, 0.25, 0.5, 0.75] * 2  # share of the cube in each pixel

# One pixel's first channels as Blender shows them; None: they differ from pixel to pixel.
EXPECTED = {
    "Combined": (0.25, 0.5, 1.5, 1.0),
    "Alpha": (1.0,),
    "Depth": (5.0,),
    "albedo": (0.75, 0.5, 0.25),
    "normal": (0.0, 0.0, 1.0),
    "variance": None,
    "samples": (4.0,),
    "CryptoObject00": None,
    "CryptoMaterial00": (None, 1.0),
}


def check(condition, message):
    if not condition:
        raise AssertionError(message)


def add_output(tree, writer, name, socket):
    writer.file_slots.new(name)
    tree.links.new(socket, writer.inputs[name])


def make_nodes(scene, image, folder):
    """The compositor's graph: each layer of the image, and the matte of "cube", into a file of its own."""
    tree = scene.node_tree
    tree.nodes.clear()
    source = tree.nodes.new("CompositorNodeImage")
    source.image = image
    names = [socket.name for socket in source.outputs]
    print("layers:", ", ".join(names))
    check(set(EXPECTED) == set(names), f"other layers than expected: {names}")
    matte = tree.nodes.new("CompositorNodeCryptomatteV2")
    matte.source = "IMAGE"
    matte.image = image
    matte.layer_name = "CryptoObject"
    matte.matte_id = "cube"
    writer = tree.nodes.new("CompositorNodeOutputFile")
    writer.base_path = folder
    writer.format.file_format = "OPEN_EXR"
    writer.format.color_depth = "32"
    writer.format.color_mode = "RGBA"
    writer.file_slots.clear()
    for socket in source.outputs:
        add_output(tree, writer, socket.name + "_", socket)
    add_output(tree, writer, "matte_", matte.outputs["Matte"])
    composite = tree.nodes.new("CompositorNodeComposite")  # without one Blender renders nothing
    tree.links.new(source.outputs["Combined"], composite.inputs["Image"])


def pixels_of(folder, name):
    """The four channels of each pixel of a file that the compositor wrote."""
    values = list(bpy.data.images.load(os.path.join(folder, name + "_0001.exr")).pixels)
    check(len(values) == 4 * PIXELS, f"{name}: {len(values)} values")
    return [values[i : i + 4] for i in range(0, len(values), 4)]


def check_layer(folder, name, expected):
    for pixel in pixels_of(folder, name):
        for seen, wanted in zip(pixel, expected or ()):
            check(wanted is None or math.isclose(seen, wanted, rel_tol=1e-6), f"{name}: {pixel} instead of {expected}")


def main():
    scene = bpy.context.scene
    scene.use_nodes = True
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 4, 2, 100
    with tempfile.TemporaryDirectory() as folder:
        make_nodes(scene, bpy.data.images.load(sys.argv[-1]), folder)
        bpy.ops.render.render()
        for name, expected in EXPECTED.items():
            check_layer(folder, name, expected)
        matte = [pixel[0] for pixel in pixels_of(folder, "matte")]
    print("matte of cube:", matte)
    check(all(math.isclose(seen, wanted, abs_tol=1e-6) for seen, wanted in zip(matte, CUBE)), f"matte: {matte}")


main()
