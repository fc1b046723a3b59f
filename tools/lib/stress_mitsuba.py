"""Steps of `isolux stress` with Mitsuba 3 in single precision: run by the Python that has it.

    stress_mitsuba.py FOLDER OUTPUT.json

FOLDER holds what `isolux stress --export` writes. What a scene needs and Mitsuba has not, or means differently, is left out.
"""

import json
import math
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

from peers_mitsuba import colour
from peers_scene import turned_about

SEEDS = 8
STUDENT_7 = 2.3646  # the 97.5 % quantile of seven degrees of freedom
NORMAL = 1.9600
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
LARGEST_ALPHA = 0.1  # beyond, light reflected more than once by a metal's facets, which Mitsuba leaves out, is seen
LARGEST_NEAR = 1e12  # of a near plane


class Inexpressible(Exception):
    """Mitsuba lacks something, or means something else by it."""


def number(value):
    return math.inf if value is None else value


def glass(material, alpha):
    if material["thickness"] == 0 or material["baseColor"] != [1, 1, 1]:
        raise Inexpressible("thin or tinted glass")
    if math.isfinite(number(material["attenuationDistance"])):
        raise Inexpressible("absorption")
    indices = {"int_ior": material["ior"], "ext_ior": 1.0}
    if alpha < 1e-5:
        return {"type": "dielectric", **indices}
    if alpha > LARGEST_ALPHA:
        raise Inexpressible("rough glass")
    return {"type": "roughdielectric", "distribution": "ggx", "alpha": alpha, **indices}


def metal(material, alpha):
    if material["baseColor"] != [1, 1, 1] or alpha > LARGEST_ALPHA:
        raise Inexpressible("coloured or very rough metal")
    if alpha < 1e-5:
        return {"type": "conductor", "material": "none"}
    return {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": alpha}


def bsdf(material):
    alpha = material["roughness"] ** 2
    if material["unlit"] or not material["opaque"]:
        raise Inexpressible("unlit or see-through surfaces")
    if material["transmission"] == 1:
        return glass(material, alpha)
    if material["metallic"] == 1:
        return {"type": "twosided", "nested": metal(material, alpha)}
    if material["transmission"] or material["metallic"] or material["specular"]:
        raise Inexpressible("mixed surfaces")
    return {"type": "twosided", "nested": {"type": "diffuse", "reflectance": colour(material["baseColor"])}}


def properties(material):
    found = {"bsdf": bsdf(material)}
    if any(material["emission"]):
        if material["doubleSided"]:
            raise Inexpressible("lamps that shine from both sides")
        found["emitter"] = {"type": "area", "radiance": colour(material["emission"])}
    return found


def matrix_of(owner, key):
    return np.array(owner[key]).reshape(4, 4)


def vertices(body):
    """In the world, rounded once: the best that single precision can hold."""
    matrix = matrix_of(body, "worldFromObject")
    return (np.array(body["positions"]).reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32)


def triangles(body):
    return np.array(body["triangles"], dtype=np.uint32).reshape(-1, 3)


def mesh(body, materials, name):
    matrix, world, faces = matrix_of(body, "worldFromObject"), vertices(body), triangles(body)
    if np.linalg.det(matrix[:3, :3]) < 0:
        faces = faces[:, ::-1]
    props = mi.Properties()
    for key, value in properties(materials[body["material"]]).items():
        props[key] = mi.load_dict(value)
    smooth = bool(body["normals"])
    if not smooth:
        props["face_normals"] = True
    made = mi.Mesh(name, len(world), len(faces), has_vertex_normals=smooth, props=props)
    params = mi.traverse(made)
    params["vertex_positions"], params["faces"] = world.ravel(), faces.ravel()
    if smooth:
        normals = np.array(body["normals"]).reshape(-1, 3) @ np.linalg.inv(matrix[:3, :3])
        params["vertex_normals"] = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32).ravel()
    params.update()
    return made


def light(entry):
    if entry["kind"] == "point":
        return {"type": "point", "position": entry["position"], "intensity": colour(entry["intensity"])}
    if entry["kind"] == "directional":
        return {"type": "directional", "direction": entry["direction"], "irradiance": colour(entry["intensity"])}
    raise Inexpressible("spots")


def to_segments(point, begins, ends):
    """The distances from a point."""
    along, to_point = ends - begins, point - begins
    squares = np.sum(along * along, axis=1)
    share = np.divide(np.sum(to_point * along, axis=1), squares, out=np.zeros_like(squares), where=squares > 0)
    return np.linalg.norm(to_point - np.clip(share, 0, 1)[:, None] * along, axis=1)


def to_triangles(point, corners):
    """The distances from a point: to the nearest edge or, from points above a triangle, to its plane."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    edges = [(a, b), (b, c), (c, a)]
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    above = length > 0
    for begin, end in edges:
        above &= np.sum(np.cross(normal, end - begin) * (point - begin), axis=1) >= 0
    height = np.abs(np.sum(normal * (point - a), axis=1))
    planes = np.divide(height, length, out=np.full_like(length, np.inf), where=above)
    return np.min([planes, *(to_segments(point, begin, end) for begin, end in edges)], axis=0)


def reach(scene, eye):
    """The distances of the nearest and the farthest point of all shapes, rounded to single precision; 1 without any."""
    nearest, farthest = [], []
    for body in scene["meshes"]:
        corners = vertices(body).astype(np.float64)[triangles(body)]
        if len(corners):
            nearest.append(to_triangles(eye, corners).min())
            farthest.append(np.linalg.norm(corners - eye, axis=2).max())
    for sphere in scene["spheres"]:
        distance, radius = np.linalg.norm(np.float64(np.float32(sphere["center"])) - eye), sphere["radius"]
        nearest.append(abs(distance - radius))
        farthest.append(distance + radius)
    return float(min(nearest, default=1.0)), float(max(farthest, default=1.0)) or 1.0


def near_plane(scene, nearest, farthest):
    """Before all that is seen, so that it clips nothing, in the corners of wide images too, where it is farther off.

    Rays begin on it. Chosen by the scene's size alone, it would cut away what is close to the camera in a large scene.
    It is not much nearer than need be, nor as far as it might be: a direction is a point of the plane, normalised,
    whose squares leave single precision below 1e-19 and above 1e19. From an eye on a surface (at 0 but for rounding)
    rays begin a little off it. Parallel rays begin beside the eye, where something may lie at any depth: a little way
    as well.
    """
    little = 1e-7 * farthest
    if scene["camera"]["orthographic"] or nearest < 1e-13 * farthest:
        return min(little, LARGEST_NEAR)
    slope = math.tan(scene["camera"]["yfov"] / 2)
    corner = math.hypot(1, slope, slope * scene["width"] / scene["height"])
    return min(0.5 * nearest / corner, LARGEST_NEAR)


def sensor(scene):
    """Its planes before and behind whatever there is: both renderers are to see it all."""
    camera, matrix = scene["camera"], matrix_of(scene["camera"], "worldFromCamera")
    film = {"type": "hdrfilm", "width": scene["width"], "height": scene["height"], "pixel_format": "rgb",
            "component_format": "float32", "rfilter": {"type": "box"}}
    if scene["aperture"]:
        raise Inexpressible("thin lenses")
    nearest, farthest = reach(scene, np.float64(np.float32(matrix[:3, 3])))
    common = {"near_clip": near_plane(scene, nearest, farthest), "far_clip": 10 * farthest, "film": film,
              "sampler": {"type": "independent"}}
    turned = np.array(turned_about(matrix.tolist()))
    if not camera["orthographic"]:
        return {"type": "perspective", "fov": math.degrees(camera["yfov"]), "fov_axis": "y",
                "to_world": mi.ScalarTransform4f(turned), **common}
    if scene["width"] != scene["height"]:
        raise Inexpressible("orthographic images that are not square")
    turned[:3, :2] *= camera["ymag"]
    return {"type": "orthographic", "to_world": mi.ScalarTransform4f(turned), **common}


def load(scene):
    depth = -1 if scene["maxDepth"] is None else scene["maxDepth"] + 1
    made = {"type": "scene", "integrator": {"type": "path", "max_depth": depth}, "sensor": sensor(scene)}
    for number_, body in enumerate(scene["meshes"]):
        made[f"mesh {number_}"] = mesh(body, scene["materials"], f"mesh {number_}")
    for number_, body in enumerate(scene["spheres"]):
        made[f"sphere {number_}"] = {"type": "sphere", "center": body["center"], "radius": body["radius"],
                                     **properties(scene["materials"][body["material"]])}
    for number_, entry in enumerate(scene["lights"]):
        made[f"light {number_}"] = light(entry)
    if any(scene["environment"]):
        made["environment"] = {"type": "constant", "radiance": colour(scene["environment"])}
    return mi.load_dict(made)


def deviation(means, truth):
    """Relative, with its 95 % interval: the spread of the seeds and what is known of the truth."""
    low, expected, high = truth
    known = (high - low) / (2 * NORMAL) if low is not None and high is not None else 0.0
    error = math.sqrt(np.var(means, ddof=1) / len(means) + known ** 2)
    estimate = np.mean(means) / expected - 1
    half = STUDENT_7 * error / abs(expected)
    return [float(estimate - half), float(estimate), float(estimate + half)]


def figures(scene, name):
    result = {"renderer": name, "bias": [None] * 3, "error": [None] * 3, "tried": 0, "nonFinite": 0}
    begin = time.perf_counter()
    try:
        loaded = load(scene)
        spp = max(1, scene["samples"] // SEEDS)
        images = [np.array(mi.render(loaded, spp=spp, seed=seed), dtype=np.float64)[..., :3] @ LUMINANCE
                  for seed in range(SEEDS)]
        # Pixels, both: a mean that is not finite does not tell how many samples are not.
        result["tried"] = sum(image.size for image in images)
        result["nonFinite"] = int(sum(np.count_nonzero(~np.isfinite(image)) for image in images))
        if result["nonFinite"]:
            result["failure"] = f"{result['nonFinite']} of {result['tried']} pixels NaN or infinite"
        elif scene["truth"][1]:
            result["error"] = deviation([image.mean() for image in images], scene["truth"])
    except RuntimeError as error:
        result["failure"] = "Mitsuba: " + next(filter(None, map(str.strip, str(error).splitlines()[::-1])), "an error")[:120]
    result["seconds"] = time.perf_counter() - begin
    return result


def agrees(step):
    """Whether an error of 1 % is not ruled out."""
    low, _, high = step["figures"][0]["error"]
    return low is not None and low <= 0.01 and high >= -0.01


def main():
    folder, output = map(pathlib.Path, sys.argv[1:])
    families = {}
    left_out = {}
    files = sorted(folder.glob("*.json"))
    for done, file in enumerate(files):
        scene = json.loads(file.read_text())
        if done % 20 == 0:
            print(f"Mitsuba: {done} of {len(files)} steps", file=sys.stderr, flush=True)
        try:
            found = figures(scene, f"Mitsuba {mi.__version__} scalar_rgb")
        except Inexpressible as reason:
            left_out[f"{scene['family']}, {scene['sweep']}"] = str(reason)
            continue
        steps = families.setdefault(scene["family"], {}).setdefault(scene["sweep"], [])
        steps.append({"label": scene["label"], "figures": [found]})
    for family, sweeps in families.items():
        for sweep in [name for name, steps in sweeps.items() if not any(map(agrees, steps))]:
            del sweeps[sweep]
            left_out[f"{family}, {sweep}"] = "it means something else by the gentlest of steps as well"
    for place, reason in left_out.items():
        print(f"left out: {place}: {reason}", file=sys.stderr)
    document = {"families": [{"name": name, "sweeps": [{"name": sweep, "steps": steps} for sweep, steps in sweeps.items()]}
                             for name, sweeps in families.items()]}
    output.write_text(json.dumps(document))


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
