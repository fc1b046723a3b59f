"""The arithmetic of tools/bench/peers: what a scene becomes for the other renderers, errors against two references, equality of
images, how many samples are taken, tables."""

import array
import json
import math
import pathlib
import random
import statistics
import sys
import tempfile
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "lib"))
sys.dont_write_bytecode = True
import peers_errors
import peers_plan
import peers_scene
import peers_scene_run
import peers_table
from scene_shapes import about_y, looking


def scene_file(name):
    return ROOT / "scenes" / name / f"{name}.gltf"


def exported(name):
    with tempfile.TemporaryDirectory() as folder:
        peers_scene.export(scene_file(name), pathlib.Path(folder))
        scene = json.loads((pathlib.Path(folder) / "scene.json").read_text())
        return scene, (pathlib.Path(folder) / "scene.bin").read_bytes()


def material(metallic=0.0, roughness=1.0, colour=(0.5, 0.5, 0.5), **extensions):
    return {"name": "it", "pbrMetallicRoughness": {"metallicFactor": metallic, "roughnessFactor": roughness,
                                                   "baseColorFactor": [*colour, 1.0]},
            "extensions": {f"KHR_materials_{key}": value for key, value in extensions.items()}}


LAMBERT = {"specular": {"specularFactor": 0.0}}
GLASS = {"transmission": {"transmissionFactor": 1.0}, "ior": {"ior": 1.4}, "volume": {"thicknessFactor": 1.0}}
WHITE = (1.0, 1.0, 1.0)


class Matrices(unittest.TestCase):
    def assertClose(self, found, expected):
        for own, other in zip(found, expected):
            self.assertAlmostEqual(own, other, places=6)

    def test_node_is_scaled_then_turned_then_moved(self):
        # Turned by a quarter about y, +x goes to -z.
        matrix = peers_scene.node_matrix({"translation": [1, 2, 3], "rotation": about_y(90), "scale": [2, 3, 4]})
        self.assertClose(peers_scene.moved([1, 0, 0, 0, 1, 0, 0, 0, 1], matrix), [1, 2, 1, 1, 5, 3, 5, 2, 3])

    def test_matrix_is_stored_by_columns(self):
        matrix = peers_scene.node_matrix({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]})
        self.assertClose(peers_scene.moved([0, 0, 0], matrix), [5, 6, 7])

    def test_normals_stay_upright_under_uneven_scales(self):
        matrix = peers_scene.node_matrix({"scale": [1, 4, 1]})
        slope = 1 / math.sqrt(2)
        # The surface x + y = 0 becomes x + y/4 = 0.
        self.assertClose(peers_scene.turned([slope, slope, 0], matrix), [4 / math.sqrt(17), 1 / math.sqrt(17), 0])

    def test_mirrored_meshes_keep_their_fronts(self):
        matrix = peers_scene.node_matrix({"scale": [-1, 1, 1]})
        self.assertEqual(list(peers_scene.facing([0, 1, 2], matrix)), [0, 2, 1])
        self.assertClose(peers_scene.turned([1, 0, 0, 0, 1, 0], matrix), [-1, 0, 0, 0, 1, 0])

    def test_camera_for_mitsuba_looks_the_same_way_with_x_to_the_left(self):
        matrix = peers_scene.node_matrix({"translation": [1, 2, 3], "rotation": looking(-20, 30)})
        turned = peers_scene.turned_about(matrix)
        self.assertClose([row[2] for row in turned], [-row[2] for row in matrix])
        self.assertClose([row[0] for row in turned], [-row[0] for row in matrix])
        for column in (1, 3):
            self.assertClose([row[column] for row in turned], [row[column] for row in matrix])
        self.assertAlmostEqual(peers_scene.determinant(turned), 1.0, places=6)


class Materials(unittest.TestCase):
    def test_kinds(self):
        kinds = [(material(**LAMBERT), {"kind": "diffuse", "colour": [0.5, 0.5, 0.5]}),
                 (material(1.0, 0.0, WHITE), {"kind": "mirror"}),
                 (material(1.0, 0.5, WHITE), {"kind": "metal", "alpha": 0.25}),
                 (material(0.0, 0.0, WHITE, **GLASS), {"kind": "glass", "ior": 1.4})]
        for found, expected in kinds:
            self.assertEqual(peers_scene.material_of(found), {**expected, "emission": [0.0] * 3})

    def test_lamps(self):
        lamp = material(colour=(0.0, 0.0, 0.0), emissive_strength={"emissiveStrength": 4.0}, **LAMBERT)
        lamp["emissiveFactor"] = [1.0, 0.5, 0.25]
        self.assertEqual(peers_scene.material_of(lamp)["emission"], [4.0, 2.0, 1.0])

    def test_what_differs_is_refused_by_name(self):
        grey_lamp = {**material(**LAMBERT), "emissiveFactor": [1.0, 1.0, 1.0]}
        textured = material(**LAMBERT)
        textured["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
        for found in (material(), material(1.0, 0.3), material(0.5, **LAMBERT), material(0.0, 0.2, WHITE, **GLASS),
                      material(0.0, 0.0, **GLASS), grey_lamp, textured):
            with self.assertRaisesRegex(peers_scene.Unsupported, "material 'it': "):
                peers_scene.material_of(found)


class Scenes(unittest.TestCase):
    def test_lamp_of_the_cornell_box_is_a_rectangle_that_faces_down(self):
        scene, data = exported("cornell_box")
        body = next(body for body in scene["bodies"] if body["name"] == "lamp")
        positions = peers_scene.read_numbers(data, body["positions"], "f")
        corner, u, v = peers_scene.rectangle(positions, peers_scene.read_numbers(data, body["indices"], "I"))
        normal = [u[(axis + 1) % 3] * v[(axis + 2) % 3] - u[(axis + 2) % 3] * v[(axis + 1) % 3] for axis in range(3)]
        self.assertAlmostEqual(corner[1], 1.99, places=6)
        for found, expected in zip(normal, [0.0, -0.2, 0.0]):
            self.assertAlmostEqual(found, expected, places=6)
        self.assertEqual(scene["materials"][body["material"]]["emission"], [15.0, 12.0, 9.0])

    def test_counts_are_those_promised(self):
        for name in ("cornell_box", "cornell_spheres", "veach_mis", "glossy", "glass"):
            expected = json.loads((scene_file(name).parent / "expected.json").read_text())
            scene, _ = exported(name)
            spheres = [body for body in scene["bodies"] if "sphere" in body]
            triangles = sum(body["indices"][1] // 3 for body in scene["bodies"] if "sphere" not in body)
            self.assertEqual((len(spheres), triangles), (expected["spheres"], expected["triangles"]), name)

    def test_meshes_of_spheres_lie_on_them(self):
        scene, data = exported("cornell_spheres")
        body = next(body for body in scene["bodies"] if body["name"] == "left sphere")
        centre, radius = body["sphere"]["centre"], body["sphere"]["radius"]
        self.assertAlmostEqual(radius, 0.4, places=6)
        points = peers_scene.read_numbers(data, body["positions"], "f")
        for at in range(0, len(points), 3000):
            self.assertAlmostEqual(math.dist(points[at:at + 3], centre), radius, places=6)

    def test_punctual_lights_are_refused(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(peers_scene.Unsupported):
            peers_scene.export(scene_file("courtyard"), pathlib.Path(folder))

    def test_what_is_no_rectangle_is_none(self):
        square = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]
        self.assertIsNotNone(peers_scene.rectangle(square, [0, 1, 2, 0, 2, 3]))
        self.assertIsNone(peers_scene.rectangle([0, 0, 0, 1, 0, 0, 2, 1, 0, 1, 1, 0], [0, 1, 2, 0, 2, 3]))
        self.assertIsNone(peers_scene.rectangle(square, [0, 2, 1, 0, 3, 2]))


def noisy(generator, truth, deviation):
    return array.array("f", [value + generator.gauss(0.0, deviation) for value in truth])


class Errors(unittest.TestCase):
    def test_by_hand(self):
        found = peers_errors.errors([3.0, 1.0, 1.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0])
        self.assertAlmostEqual(found["mse"], 2 / 3)
        self.assertAlmostEqual(found["mae"], 0.5)
        self.assertAlmostEqual(found["rel_mse"], 2 / (1.5**2 + 0.01) / 3)
        self.assertAlmostEqual(found["relative_rmse"], math.sqrt(2 / 3) / (3.5 / 3))
        level = 0.2126 * 1.5 + 0.7152 + 0.0722
        self.assertAlmostEqual(found["bias"], 0.2126 * 1.5 / level)

    def test_worst_pixels_are_trimmed(self):
        image = [1.0] * 3000
        image[30:33] = [101.0] * 3
        found = peers_errors.errors(image, [1.0] * 3000, [1.0] * 3000)
        self.assertGreater(found["rel_mse"], 9.0)
        self.assertEqual(found["rel_mse_trimmed"], 0.0)

    def test_two_references_bring_no_noise_of_theirs(self):
        generator = random.Random(1)
        truth = [0.5 + 0.4 * math.sin(index) for index in range(30000)]
        image, first, second = (noisy(generator, truth, 0.1) for _ in range(3))
        # Of 30,000 products with variance 3e-4: the mean's standard error is 1e-4.
        self.assertAlmostEqual(peers_errors.errors(image, first, second)["mse"], 0.01, delta=5e-4)
        # sqrt(0.02)/2/0.5, of 30,000 squares: relative standard error sqrt(2/30000)/2.
        self.assertAlmostEqual(peers_errors.reference_noise(first, second), 0.1414, delta=0.003)

    def test_equal_images_are_found_equal_and_brighter_ones_not(self):
        generator = random.Random(2)
        truth = [0.5 + 0.2 * math.sin(index / 7) for index in range(3 * 64 * 64)]
        own, same = ([noisy(generator, truth, 0.05) for _ in range(8)] for _ in range(2))
        other = [array.array("f", [1.02 * value for value in noisy(generator, truth, 0.05)]) for _ in range(8)]
        equal, brighter = peers_errors.compare(same, own, 64), peers_errors.compare(other, own, 64)
        self.assertFalse(peers_errors.differs(equal["bias"], 0.005))
        self.assertTrue(peers_errors.differs(brighter["bias"], 0.005))
        self.assertAlmostEqual(brighter["bias"][1], 0.02, delta=0.003)
        self.assertLess(abs(equal["block"]["score"]), 2 * equal["block"]["limit"])

    def test_a_wrong_block_is_found(self):
        generator = random.Random(3)
        truth = [0.5] * (3 * 64 * 64)
        own = [noisy(generator, truth, 0.05) for _ in range(8)]
        for y in range(8, 16):
            truth[3 * (y * 64 + 24):3 * (y * 64 + 32)] = [0.6] * 24
        found = peers_errors.compare([noisy(generator, truth, 0.05) for _ in range(8)], own, 64)["block"]
        self.assertGreater(found["score"], found["limit"])
        self.assertAlmostEqual(found["relative"], 0.2, delta=0.02)


class Plans(unittest.TestCase):
    def test_levels_are_powers_of_four(self):
        self.assertEqual(peers_plan.levels(256, 4), [4, 16, 64, 256])

    def test_target_is_reached(self):
        # 1.5 * 16 * (0.4/0.05)^2 = 1536
        self.assertEqual(peers_plan.reaching(0.4, 16), 4096)
        self.assertEqual(peers_plan.reaching(0.01, 16), peers_plan.LEAST)
        self.assertEqual(peers_plan.reaching(-0.01, 16), peers_plan.LEAST)

    def test_dearest_gives_way(self):
        costs, errors = {"fast": 0.001, "slow": 0.01}, {"fast": 0.4, "slow": 0.4}
        self.assertEqual(peers_plan.plan(costs, errors, 16, 1000.0, 4), {"fast": 4096, "slow": 4096})
        self.assertEqual(peers_plan.plan(costs, errors, 16, 20.0, 4), {"fast": 4096, "slow": 1024})

    def test_references_fit_their_time(self):
        self.assertEqual(peers_plan.reference_samples(0.01, 100.0, 8), 1024)
        self.assertEqual(peers_plan.reference_samples(0.02, 100.0, 8), 256)
        self.assertEqual(peers_plan.reference_samples(0.02, 100.0, 8, 2), 512)
        self.assertEqual(peers_plan.reference_samples(1.0, 1.0, 8), peers_plan.REFERENCE_LEAST)


class FakeRenderer:
    """Renders a grey image whose noise falls with the root of samples."""
    asked = 0

    def __init__(self, name, size, brightness):
        self.name, self.size, self.brightness = name, size, brightness

    def render(self, spp, seed):
        FakeRenderer.asked += 1
        generator = random.Random(f"{self.name} {spp} {seed}")
        image = noisy(generator, [self.brightness] * (3 * self.size**2), 0.5 / math.sqrt(spp))
        return types.SimpleNamespace(image=image, seconds=1e-3 * spp, setup=0.1, device_seconds=None, rays=0)

    def close(self):
        pass


class FakeRenderers:
    def __init__(self, size):
        self.size = size

    def start(self, variant, scene, folder):
        if variant.renderer == "mitsuba":
            raise peers_scene_run.Missing("no Mitsuba here")
        return FakeRenderer(variant.name, self.size, 0.52 if variant.renderer == "cycles" else 0.5)


class Runs(unittest.TestCase):
    def run_scene(self, folder, rounds):
        options = types.SimpleNamespace(size=16, seconds=8.0, rounds=rounds, levels=2, only=[], equality=False)
        path = scene_file("cornell_box")
        run = peers_scene_run.SceneRun(path.stem, path, pathlib.Path(folder), FakeRenderers(16), options)
        return run, run.run()

    def test_a_run_goes_on_where_it_stopped_and_says_what_differs(self):
        with tempfile.TemporaryDirectory() as folder, quiet():
            first, equality = self.run_scene(folder, 1)
            self.assertEqual(set(equality), {"isolux", "cycles"})
            self.assertIn("mitsuba llvm", first.missing)
            self.assertTrue(equality["cycles"]["differs"])
            before = first.rows_kept()
            self.assertEqual(len(before), 4 * 2)
            second, _ = self.run_scene(folder, 2)
            self.assertEqual(second.rows_kept()[:8], before)
            self.assertEqual(len(second.rows_kept()), 16)
            self.check_errors(second.complete_rows())
            asked = FakeRenderer.asked
            self.run_scene(folder, 2)
            self.assertEqual(FakeRenderer.asked - asked, 2 * 4)  # warming up alone

    def check_errors(self, rows):
        """Against its own references where it differs: noise alone. Of 768 values twice: relative standard error 3 %."""
        for name, level in (("isolux", 0.5), ("cycles sobol", 0.52)):
            for checkpoint in ("0", "1"):
                own = [row for row in rows if row["variant"] == name and row["checkpoint"] == checkpoint]
                expected = 0.5 / math.sqrt(int(own[0]["samples_per_pixel"])) / level
                found = statistics.fmean(float(row["relative_rmse"]) for row in own)
                self.assertAlmostEqual(found / expected, 1.0, delta=0.15)


class quiet:
    """Keeps what a run says of its progress from the test's output."""

    def __enter__(self):
        self.kept = peers_scene_run.say
        peers_scene_run.say = lambda text: None

    def __exit__(self, *_):
        peers_scene_run.say = self.kept


FIT = {"variants": [{"name": "isolux", "setupSeconds": 0.1, "slopeTime": [-1.1, -1.0, -0.9],
                     "checkpoints": [{"samplesPerPixel": 256}],
                     "timeTo": [{"error": 0.05, "seconds": [1.9, 2.0, 2.1], "extrapolated": False, "reason": ""}]},
                    {"name": "mitsuba llvm", "setupSeconds": 0.2, "slopeTime": [None, None, None],
                     "checkpoints": [{"samplesPerPixel": 64}],
                     "timeTo": [{"error": 0.05, "seconds": [0.9, 1.0, 1.1], "extrapolated": True, "reason": ""}]}],
       "ratios": [{"faster": "mitsuba llvm", "slower": "isolux", "error": 0.05, "ratio": [1.6, 2.0, 2.5],
                   "extrapolated": True}]}


class Tables(unittest.TestCase):
    def test_times_and_ratios(self):
        lines = peers_table.times_table([{"scene": "glass", "fit": FIT}]).splitlines()
        self.assertEqual(lines[2], "| glass | isolux | 2 s [1.9, 2.1] | 1 | -1.00 | 0.1 s | 256 |")
        self.assertEqual(lines[3], "| glass | mitsuba llvm | 1 s [0.9, 1.1] (extrapolated) | 0.5 [0.4, 0.62] of isolux |  "
                                   "| 0.2 s | 64 |")

    def test_equality(self):
        found = {"relativeRmse": 0.01, "samplesPerPixel": 512}
        block = {"score": -3.0, "limit": 4.2, "relative": -0.02}
        other = {**found, "bias": [-0.001, 0.002, 0.005], "block": block, "differs": False}
        lines = peers_table.equality_table([{"scene": "glass", "equality": {"isolux": found, "cycles": other}}]).splitlines()
        self.assertEqual(lines[3], "| glass | cycles | +0.20 % [-0.10, +0.50] | -2.0 %, 3.0 σ | 4.2 σ "
                                   "| 1.00 % (512 samples) | Isolux's |")


if __name__ == "__main__":
    unittest.main(verbosity=0)
