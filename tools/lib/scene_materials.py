"""The scene `materials`: a body for each thing that a surface can be."""

import scene_images as images
from scene_gltf import FLOAT, Gltf
from scene_shapes import about_y, box_quads, geodesic, looking

SKY = [0.18, 0.22, 0.3]
REPEAT, LINEAR = 10497, 9729
WHOLE = [(0, 1), (1, 1), (1, 0), (0, 0)]  # an image over a quadrilateral, its lower left corner first


def unit_sphere(gltf):
    """Positions, which are the normals as well, and triangles."""
    points, triangles = geodesic(4)
    return (points, gltf.accessor([c for point in points for c in point], FLOAT, 3),
            gltf.indices([i for triangle in triangles for i in triangle]))


def add_balls(gltf, points, positions, triangles):
    """Exact spheres: rough metal, glass that absorbs, rough glass; and a mesh with coloured vertices."""
    gold = gltf.surface("rough gold", 1.0, 0.35, baseColorFactor=[1.0, 0.72, 0.33, 1.0])
    glass = gltf.surface("bottle glass", 0.0, 0.0, {
        "transmission": {"transmissionFactor": 1.0}, "ior": {"ior": 1.5},
        "volume": {"thicknessFactor": 0.8, "attenuationColor": [0.25, 0.75, 0.5], "attenuationDistance": 0.5}})
    frosted = gltf.surface("frosted glass", 0.0, 0.4, {
        "transmission": {"transmissionFactor": 1.0}, "ior": {"ior": 1.4}, "volume": {"thicknessFactor": 0.4}})
    for name, material, radius, centre in [("gold ball", gold, 0.45, [-1.45, 0.45, -0.25]),
                                           ("glass ball", glass, 0.42, [0.52, 0.42, 0.15]),
                                           ("frosted ball", frosted, 0.2, [1.0, 0.2, 1.0])]:
        mesh = gltf.mesh(name, material, {"POSITION": positions, "NORMAL": positions}, triangles)
        gltf.node(name, mesh=mesh, translation=centre, scale=[radius] * 3, extras={"sphere": {"radius": 1.0}})
    glossy = gltf.surface("glossy", 0.0, 0.08)
    colours = gltf.accessor([0.5 + 0.45 * c for point in points for c in point], FLOAT, 3)
    mesh = gltf.mesh("coloured ball", glossy, {"POSITION": positions, "NORMAL": positions, "COLOR_0": colours}, triangles)
    gltf.node("coloured ball", mesh=mesh, translation=[-0.85, 0.22, 0.95], scale=[0.22] * 3)


def add_boxes(gltf):
    """Plastic with a normal map, and a lantern: a lamp in a lattice cut out by a mask."""
    linear = {"magFilter": LINEAR, "minFilter": LINEAR, "wrapS": REPEAT, "wrapT": REPEAT}
    plastic = gltf.surface("plastic", 0.0, 0.15, baseColorFactor=[0.65, 0.06, 0.05, 1.0],
                           normalTexture={**gltf.texture("bumps", images.bumps(64, 4, 0.9), **linear), "scale": 1.0})
    unit = box_quads((-1, -1, -1), (1, 1, 1))
    gltf.node("plastic box", mesh=gltf.quads("plastic box", plastic, unit, WHOLE), translation=[-0.5, 0.34, 0.0],
              rotation=about_y(28), scale=[0.33, 0.34, 0.33])
    lattice = gltf.surface("lattice", 1.0, 0.3, baseColorTexture=gltf.texture("lattice", images.lattice(64, 4), **linear),
                           alphaMode="MASK", alphaCutoff=0.5, doubleSided=True)
    gltf.node("lantern", mesh=gltf.quads("lantern", lattice, unit, WHOLE), translation=[1.5, 0.41, -0.2],
              rotation=about_y(-20), scale=[0.3, 0.4, 0.3])
    flame = gltf.surface("flame", 0.0, 1.0, {"emissive_strength": {"emissiveStrength": 16.0}},
                         baseColorFactor=[0.0, 0.0, 0.0, 1.0], emissiveFactor=[1.0, 0.6, 0.25])
    return flame


def add_room(gltf):
    """A tiled floor, a wall, a sign that gives light by an image, a lamp out of sight."""
    tiles = gltf.texture("tiles", images.tiles(64), magFilter=LINEAR, minFilter=LINEAR, wrapS=REPEAT, wrapT=REPEAT)
    floor = gltf.surface("tiles", 0.0, 0.3, baseColorTexture=tiles)
    ground = [[(-4, 0, 3), (4, 0, 3), (4, 0, -1.2), (-4, 0, -1.2)]]
    gltf.node("floor", mesh=gltf.quads("floor", floor, ground, [(0, 4.2), (8, 4.2), (8, 0), (0, 0)]))
    wall = gltf.material("wall", (0.6, 0.58, 0.55))
    gltf.node("wall", mesh=gltf.quads("wall", wall, [[(-4, 0, -1.2), (4, 0, -1.2), (4, 2.6, -1.2), (-4, 2.6, -1.2)]]))
    word = gltf.texture("sign", images.sign("ISOLUX", 4), magFilter=LINEAR, minFilter=LINEAR)
    lit = gltf.surface("sign", 0.0, 1.0, {"emissive_strength": {"emissiveStrength": 2.2}},
                       baseColorFactor=[0.02, 0.02, 0.02, 1.0], emissiveFactor=[1.0, 1.0, 1.0], emissiveTexture=word)
    panel = [[(-1.35, 1.22, -1.14), (1.35, 1.22, -1.14), (1.35, 2.12, -1.14), (-1.35, 2.12, -1.14)]]
    gltf.node("sign", mesh=gltf.quads("sign", lit, panel, WHOLE))
    lamp = gltf.surface("lamp", 0.0, 1.0, {"emissive_strength": {"emissiveStrength": 9.0}},
                        baseColorFactor=[0.0, 0.0, 0.0, 1.0], emissiveFactor=[1.0, 0.93, 0.84])
    x0, x1, y, z0, z1 = -1.7, -0.5, 3.0, 1.2, 2.0
    gltf.node("lamp", mesh=gltf.quads("lamp", lamp, [[(x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)]]))


def materials():
    """Metal, plastic, glass, a mask, coloured vertices, an image as a lamp, under a dim sky."""
    gltf = Gltf("materials")
    gltf.doc["scenes"][0]["extras"] = {"cgl_hemisphere_light": {"radiance": SKY}}
    add_room(gltf)
    points, positions, triangles = unit_sphere(gltf)
    add_balls(gltf, points, positions, triangles)
    mesh = gltf.mesh("flame", add_boxes(gltf), {"POSITION": positions, "NORMAL": positions}, triangles)
    gltf.node("flame", mesh=mesh, translation=[1.5, 0.4, -0.2], scale=[0.09] * 3, extras={"sphere": {"radius": 1.0}})
    gltf.camera("view", 0.52, translation=[0.35, 1.5, 5.2], rotation=looking(-9, 3.5))
    gltf.doc["cameras"][0]["perspective"]["aspectRatio"] = 4 / 3
    # Two triangles each of floor, wall, sign and lamp, twelve of each box, 320 of the ball with coloured vertices.
    return gltf, {"triangles": 352, "spheres": 4, "cameras": 1, "lights": 5, "sky": SKY, "aspectRatio": 4 / 3}
