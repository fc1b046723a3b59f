"""The room of the Cornell scenes: what stands in it is another matter."""

from scene_shapes import box_quads

WHITE, RED, GREEN, BLUE = (0.73, 0.73, 0.73), (0.65, 0.05, 0.05), (0.12, 0.45, 0.15), (0.25, 0.4, 0.7)
LIGHT_COLOUR, LIGHT_STRENGTH = (1.0, 0.8, 0.6), 15.0
SMALL_LAMP = (0.25, 0.2, LIGHT_STRENGTH)  # half of its sides, strength


def room(gltf, lamp=SMALL_LAMP):
    """A room 2 m wide, high and deep, open towards +z: white, red at the left, green at the right, lit from above.

    Returns its white material.
    """
    x, z, strength = lamp
    white, red = gltf.material("white", WHITE), gltf.material("red", RED)
    green = gltf.material("green", GREEN)
    light = gltf.material("light", (0.0, 0.0, 0.0), LIGHT_COLOUR, strength)
    inside = [list(reversed(quad)) for quad in box_quads((-1, 0, -1), (1, 2, 1))]
    _, back, right, left, ceiling, floor = inside
    gltf.node("walls", mesh=gltf.quads("walls", white, [floor, ceiling, back]))
    gltf.node("left wall", mesh=gltf.quads("left wall", red, [left]))
    gltf.node("right wall", mesh=gltf.quads("right wall", green, [right]))
    # A little below the ceiling, its front facing down.
    y = 1.99
    corners = [(-x, y, -z), (x, y, -z), (x, y, z), (-x, y, z)]
    gltf.node("lamp", mesh=gltf.quads("lamp", light, [corners]))
    # The opening, 2.8 m away, would fill a view of 2 atan(1/2.8) = 0.6860; a little less hides its rim.
    gltf.camera("camera", 0.68, translation=[0.0, 1.0, 3.8])
    return white


def room_figures(triangles, spheres, strength=LIGHT_STRENGTH):
    return {"triangles": triangles, "spheres": spheres, "cameras": 1, "lights": 2,
            "lightRadiance": [round(c * strength, 9) for c in LIGHT_COLOUR]}
