"""The scenes `veach_mis`, `glossy` and `glass`: metal and glass of which every renderer has the same idea. The metal is white,
so that no Fresnel term has a part in it, and smooth enough for light reflected more than once by its facets not to count."""

import math

from scene_gltf import FLOAT, Gltf
from scene_room import room, room_figures
from scene_shapes import about_y, box_quads, cross, geodesic, looking, normalised

# What mirrors and glass gather of a lamp is found by chance alone: the larger it is, the more often.
LARGE_LAMP = (0.7, 0.7, 2.0)
CAMERA = (0.0, 2.2, 6.5)
LAMPS = (0.0, 4.2, -0.4)  # the middle of their row, above the picture
LAMP_POWER = 1.3  # radiance times area, of each
LAMP_HALVES = [(-1.75, 0.14), (-0.85, 0.22), (0.25, 0.34), (1.6, 0.5)]  # where in the row, half of the side
# GGX's alpha is the roughness squared: 0.003, 0.01, 0.025, 0.05. Heights and distances of the plates' middles.
PLATES = [(0.0548, 1.30, 0.2), (0.1, 0.85, 1.0), (0.1581, 0.48, 1.8), (0.2236, 0.20, 2.6)]


def metal(gltf, name, roughness):
    return gltf.surface(name, 1.0, roughness, baseColorFactor=[1.0, 1.0, 1.0, 1.0])


def ball(gltf, name, material, radius, centre):
    """An exact sphere; on the unit sphere a point is its own normal."""
    points, triangles = geodesic(4)
    points = gltf.accessor([c for point in points for c in point], FLOAT, 3)
    triangles = gltf.indices([i for triangle in triangles for i in triangle])
    mesh = gltf.mesh(name, material, {"POSITION": points, "NORMAL": points}, triangles)
    gltf.node(name, mesh=mesh, translation=centre, scale=[radius] * 3, extras={"sphere": {"radius": 1.0}})


def towards(start, end):
    return normalised([b - a for a, b in zip(start, end)])


def add_plate(gltf, number, roughness, height, distance):
    """Turned about x so that its middle mirrors the middle of the lamps to the camera."""
    middle = (0.0, height, distance)
    half = normalised([a + b for a, b in zip(towards(middle, CAMERA), towards(middle, LAMPS))])
    plate = gltf.quads(f"plate {number}", metal(gltf, f"metal {number}", roughness),
                       box_quads((-2.2, -0.02, -0.33), (2.2, 0.02, 0.33)))
    gltf.node(f"plate {number}", mesh=plate, translation=list(middle),
              rotation=looking(math.degrees(math.atan2(half[2], half[1])), 0))


def add_lamp(gltf, number, x, half):
    """A square about a point of the row, its front towards the plates."""
    centre = (x, *LAMPS[1:])
    normal = towards(centre, (x, 0.7, 1.4))
    side = (half, 0.0, 0.0)
    up = [half * c for c in cross(normal, (1.0, 0.0, 0.0))]
    corners = [[round(c + s * a + t * b, 6) for c, a, b in zip(centre, side, up)]
               for s, t in [(-1, -1), (1, -1), (1, 1), (-1, 1)]]
    radiance = LAMP_POWER / (4 * half * half)
    material = gltf.material(f"lamp {number}", (0.0, 0.0, 0.0), (1.0, 1.0, 1.0), round(radiance, 6))
    gltf.node(f"lamp {number}", mesh=gltf.quads(f"lamp {number}", material, [corners]))


def veach_mis():
    """Four plates of metal, from nearly a mirror to quite rough, that reflect four lamps of equal power."""
    gltf = Gltf("veach_mis")
    grey = gltf.material("grey", (0.4, 0.4, 0.4))
    stage = [[(-5, 0, 6), (5, 0, 6), (5, 0, -1.5), (-5, 0, -1.5)], [(-5, 0, -1.5), (5, 0, -1.5), (5, 6, -1.5), (-5, 6, -1.5)]]
    gltf.node("stage", mesh=gltf.quads("stage", grey, stage))
    for number, plate in enumerate(PLATES, 1):
        add_plate(gltf, number, *plate)
    for number, lamp in enumerate(LAMP_HALVES, 1):
        add_lamp(gltf, number, *lamp)
    gltf.camera("camera", 0.62, translation=list(CAMERA), rotation=looking(-15, 0))
    return gltf, {"triangles": 60, "spheres": 0, "cameras": 1, "lights": 8}


def glossy():
    """The room with a mirror and two rough metals."""
    gltf = Gltf("glossy")
    room(gltf, LARGE_LAMP)
    ball(gltf, "mirror ball", metal(gltf, "mirror", 0.0), 0.35, [0.45, 0.35, -0.25])
    ball(gltf, "rough ball", metal(gltf, "rough metal", 0.2236), 0.25, [-0.05, 0.25, 0.55])
    box = gltf.quads("box", metal(gltf, "brushed metal", 0.1414), box_quads((-1, -1, -1), (1, 1, 1)))
    # 1 cm deep in the floor, so that no light leaks in below.
    gltf.node("tall box", mesh=box, translation=[-0.45, 0.595, -0.35], rotation=about_y(22), scale=[0.28, 0.605, 0.28])
    return gltf, room_figures(24, 2, LARGE_LAMP[2])


def glass():
    """The room with a ball and a block of clear glass."""
    gltf = Gltf("glass")
    room(gltf, LARGE_LAMP)
    clear = gltf.surface("clear glass", 0.0, 0.0, {
        "transmission": {"transmissionFactor": 1.0}, "ior": {"ior": 1.5}, "volume": {"thicknessFactor": 0.5}})
    ball(gltf, "glass ball", clear, 0.38, [-0.42, 0.4, 0.25])
    block = gltf.quads("glass block", clear, box_quads((-1, -1, -1), (1, 1, 1)))
    # Nothing touches the floor: whether a surface lies within glass or outside is then no question of rounding.
    gltf.node("glass block", mesh=block, translation=[0.4, 0.52, -0.3], rotation=about_y(-25), scale=[0.26, 0.5, 0.26])
    return gltf, room_figures(24, 1, LARGE_LAMP[2])
