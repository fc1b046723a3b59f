"""Runs the reduced study on the project's own scenes and holds its figures against what they must be.

    reduced.py --program ISOLUX --output FOLDER
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
STUDY = ROOT / "tools" / "study"
SECTIONS = ["normals", "light", "soft", "bounces", "roulette", "samples", "adaptive", "gallery"]

# Independent samples have a slope of -0.5. Three seeds of 32 x 32 pixels move it by some hundredths; an image that does not
# converge has 0, one that converges at twice the rate -1: both are far outside.
SLOPE = (-0.65, -0.35)


def parse_options():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    return parser.parse_args()


def run_study(*arguments):
    command = [sys.executable, str(STUDY), "-o", str(options.output), *arguments]
    return subprocess.run(command, capture_output=True, text=True)


class ReducedStudy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        result = run_study("--reduced", "--scenes", str(ROOT / "scenes"), "--program", str(options.program))
        if result.returncode != 0:
            raise AssertionError(result.stdout + result.stderr)
        cls.sections = {found["name"]: found for found in json.loads((options.output / "results.json").read_text())["sections"]}
        cls.page = (options.output / "index.html").read_text()

    def figures(self, name):
        return self.sections[name]["figures"]

    def blocks(self, kind):
        return [block for found in self.sections.values() for block in found["blocks"] if block["kind"] == kind]

    def test_every_section_has_its_figures(self):
        self.assertEqual(list(self.sections), SECTIONS)
        for name, found in self.sections.items():
            self.assertTrue(any(block["kind"] == "pictures" and block["items"] for block in found["blocks"]), name)
            self.assertIn(f'<section id="{name}">', self.page)

    def test_every_picture_is_in_the_page_with_its_measure_and_command(self):
        items = [item for block in self.blocks("pictures") for item in block["items"]]
        self.assertEqual(self.page.count('<figure><img alt='), len(items))
        for item in items:
            self.assertGreater(item["spp"], 0)
            self.assertGreater(item["seconds"], 0)
            self.assertTrue(item["command"].startswith("isolux render "))
            self.assertTrue(item["standIn"])
            self.assertTrue(item["relativeRmse"] is not None or item["label"] == "samples a pixel", item["label"])

    def test_page_needs_no_other_file(self):
        self.assertEqual(re.findall(r'(?:src|href)="(?!data:image/png;base64,|#)[^"]*"', self.page), [])
        self.assertNotRegex(self.page, r"\b(nan|inf|None)\b")

    def test_bvh_spares_tests(self):
        for entry in self.figures("normals")["scenes"]:
            boxes, triangles = entry["tests"]["none"]
            self.assertEqual(boxes, 0)
            self.assertGreaterEqual(triangles, entry["triangles"])
            for method in ("mean-split", "sah"):
                self.assertLess(entry["tests"][method][1], triangles)

    def test_mis_beats_hemisphere_sampling(self):
        for entry in self.figures("light")["scenes"]:
            methods = entry["methods"]
            self.assertLess(methods["mis"]["relativeRmse"][1], methods["hemisphere"]["relativeRmse"][1])

    def test_bounces_alone_add_up(self):
        found = self.figures("bounces")["sum"]
        self.assertGreater(found["values"], 1000)
        self.assertEqual(found["beyond"], 0, found)

    def test_constant_roulette_scatters_where_the_albedo_is_high(self):
        """Exactly, a sample's variance would grow by 1.28 a bounce with P = 0.5; with 0.3 its growth ends."""
        scatter = self.figures("roulette")["furnaceScatter"]
        self.assertGreater(scatter["constant 0.5"][-1], 1.5 * scatter["constant 0.3"][-1])
        self.assertGreater(scatter["constant 0.5"][-1], 4 * scatter["constant 0.5"][0])
        self.assertLess(scatter["off"][-1], scatter["off"][0])

    def test_roulette_ends_paths(self):
        deepest = self.figures("roulette")["depths"][-1]["methods"]
        self.assertLess(deepest["constant"]["raysPerSample"], deepest["off"]["raysPerSample"])

    def test_error_falls_with_the_root_of_samples(self):
        slope = self.figures("samples")["slope"][1]
        self.assertTrue(SLOPE[0] < slope < SLOPE[1], slope)

    def test_adaptive_takes_fewer_samples_than_its_maximum(self):
        for run in self.figures("adaptive")["runs"]:
            self.assertLess(run["meanSpp"], run["maximumSpp"])

    def test_page_can_be_made_again_without_rendering(self):
        result = run_study("--page-only")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((options.output / "index.html").read_text(), self.page)

    def test_what_is_wrong_is_said_in_one_line(self):
        for arguments in (["--only", "nothing"], ["--size", "0x3"], ["--scenes", str(ROOT / "tools")]):
            result = run_study(*arguments)
            self.assertEqual(result.returncode, 2)
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)


if __name__ == "__main__":
    options = parse_options()
    unittest.main(argv=sys.argv[:1], verbosity=0)
