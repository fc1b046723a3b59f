"""tools/report on synthetic runs: its page is well-formed, needs nothing else, holds the figures; bad input is refused.

    page.py --output FOLDER

Exit status 77 (skipped) where matplotlib is missing and cannot be installed, except in continuous integration.
"""

import argparse
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tools" / "lib"), str(pathlib.Path(__file__).parent)]
sys.dont_write_bytecode = True
import synthetic
from report_text import clock, short, short_percent

NAMES = ["cornell", "blob", "faulty", "fitted"]
VOID = {"meta", "img", "input", "br", "hr", "link"}
RASTER = b"\x89PNG"


def run_report(*arguments):
    return subprocess.run([sys.executable, str(ROOT / "tools" / "report"), *map(str, arguments)], capture_output=True, text=True)


class Checker(html.parser.HTMLParser):
    """Elements must nest; collects names, what is referred to, and the text."""

    def __init__(self):
        super().__init__()
        self.open, self.faults, self.names, self.targets, self.texts, self.images = [], [], [], [], [], []

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        if len(given) != len(attributes):
            self.faults.append(f"{self.getpos()}: an attribute of <{tag}> twice")
        if "id" in given:
            self.names.append(given["id"])
        self.targets += [given[name] for name in ("href", "src") if name in given]
        self.images += [(tag, given)] if tag == "img" or given.get("role") == "img" else []
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"{self.getpos()}: </{tag}> out of place")

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("style", "script"):
            self.texts.append(data)


def checked(page):
    checker = Checker()
    checker.feed(page)
    checker.close()
    return checker


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(options.output, ignore_errors=True)
        cls.reports = synthetic.write_all(options.output)
        cls.path = options.output / "all" / "report.html"
        result = run_report(*(options.output / name for name in NAMES), "-o", cls.path)
        if "are missing" in result.stderr and "CI" not in os.environ:
            print(result.stderr.strip())
            sys.exit(77)
        if result.returncode != 0:
            raise AssertionError(result.stdout + result.stderr)
        cls.page = cls.path.read_text()
        cls.checker = checked(cls.page)
        cls.text = " ".join(" ".join(cls.checker.texts).split())

    def test_elements_nest_and_names_are_unique(self):
        self.assertEqual(self.checker.faults + self.checker.open, [])
        self.assertEqual(len(self.checker.names), len(set(self.checker.names)))

    def test_page_needs_nothing_else(self):
        for target in self.checker.targets:
            self.assertRegex(target, r"^(#|data:image/png;base64,)")
            if target.startswith("#"):
                self.assertIn(target[1:], self.checker.names)
        self.assertNotRegex(self.page, r"https?://|@import|url\((?!#)")
        for name in re.findall(r"url\(#([^)]+)\)", self.page):
            self.assertIn(name, self.checker.names)

    def test_everything_pictured_has_words(self):
        for tag, given in self.checker.images:
            words = given.get("alt") if tag == "img" else given.get("aria-label")
            self.assertTrue(words or given.get("class") in ("under", "over"), given)

    def test_figures_of_the_runs_are_there(self):
        for name in NAMES:
            for variant in self.reports[name]["variants"]:
                figures = [clock(found["seconds"][1]) for found in variant["timeTo"] if found["seconds"][1] is not None]
                figures += [short(variant["efficiency"][1]), short(variant["slopeTime"][1])]
                figures += [short_percent(point["relativeRmse"][1]) for point in variant["checkpoints"]]
                for figure in figures:
                    self.assertIn(" ".join(figure.split()), self.text, (name, variant["name"]))

    def test_ratios_and_their_intervals_are_there(self):
        for name in NAMES:
            for ratio in self.reports[name]["ratios"]:
                low, estimate, high = map(short, ratio["ratio"])
                self.assertIn(f"×{estimate}", self.text)
                self.assertIn(f"{low} to {high}", self.text)

    def test_what_is_extrapolated_or_not_reached_is_said(self):
        self.assertIn("extrapolated", self.text)
        self.assertIn("not reached, and the error ends at a floor", self.text)

    def test_machine_and_command_are_named(self):
        for words in ("llvmpipe (LLVM 15.0.6, 256 bits)", "Mesa 22.3.6", "git 81c4575", "16 (0 to 15)", "48 × 48 pixels",
                      "isolux converge scenes/cornell_box/cornell_box.gltf", "Not recorded: scene"):
            self.assertIn(words, self.text)

    def test_names_are_escaped(self):
        self.assertNotIn("<llvm>", self.page)
        self.assertIn("mitsuba <llvm>", self.text)

    def test_nothing_unknown_is_written(self):
        self.assertNotRegex(self.text, r"\b(nan|inf|None|null)\b")

    def test_plots_are_inline_with_variants_and_both_schemes(self):
        self.assertEqual(self.page.count('<svg class="plot"'), 4 * 3 + 3)  # no calibration in the fitted one
        self.assertIn("prefers-color-scheme: dark", self.page)
        plots = "".join(re.findall(r'<svg class="plot".*?</svg>', self.page, re.S))
        self.assertEqual(set(re.findall(r"#[0-9a-f]{6}\b", plots)), set(), "a colour that no scheme changes")
        for place in range(5):
            self.assertIn(f'class="variant-{place} error"', plots)

    def test_plots_are_files_too(self):
        files = sorted(path.name for path in (options.output / "all" / "plots").iterdir())
        self.assertEqual(len(files), 2 * (4 * 3 + 3))
        for path in (options.output / "all" / "plots").iterdir():
            if path.suffix == ".svg":
                xml.etree.ElementTree.parse(path)
            else:
                self.assertTrue(path.read_bytes().startswith(RASTER))

    def test_images_are_those_of_the_run(self):
        embedded = sum(1 for target in self.checker.targets if target.startswith("data:"))
        self.assertEqual(embedded, (1 + 2 * 5) + (1 + 2 * 3) + (1 + 2 * 3 - 1))
        self.assertIn("missing", self.text)

    def test_the_same_again(self):
        run_report(*(options.output / name for name in NAMES), "-o", self.path)
        self.assertEqual(self.path.read_text(), self.page)


class Use(unittest.TestCase):
    def test_one_run_goes_beside_it(self):
        result = run_report(options.output / "blob")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.strip(), str(options.output / "blob" / "report.html"))
        found = checked((options.output / "blob" / "report.html").read_text())
        self.assertEqual(found.faults, [])
        self.assertTrue((options.output / "blob" / "plots" / "blob-error-time.png").is_file())

    def test_no_error_above_zero_has_a_page_too(self):
        report = synthetic.run(options.output / "zero", "zero", synthetic.PLAIN[:1])
        for point in report["variants"][0]["checkpoints"]:
            point.update(relativeRmse=None, estimate=None, bias=None, calibration=None)
        report["variants"][0].update(timeTo=[], efficiency=None, slopeTime=[None, None, None], floor=None, slopeHolds=None)
        report.update(ratios=[], images=None)
        synthetic.write(options.output / "zero", report)
        result = run_report(options.output / "zero")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(checked((options.output / "zero" / "report.html").read_text()).faults, [])

    def test_many_variants_are_a_list(self):
        many = [(f"variant {place}", "", 0.5 + 0.05 * place, 0.01, 1.0, 0.0) for place in range(11)]
        synthetic.run(options.output / "many", "many", many)
        result = run_report(options.output / "many")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(checked((options.output / "many" / "report.html").read_text()).faults, [])

    def test_bad_input_is_refused_in_one_line(self):
        damaged = options.output / "damaged"
        damaged.mkdir(exist_ok=True)
        (damaged / "convergence.json").write_text('{"schema": 1,')
        for arguments in ([damaged], [options.output / "nowhere"], [options.output / "blob", "-o", options.output], [], ["--no"]):
            result = run_report(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)

    def test_help_has_examples(self):
        result = run_report("--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("Examples:", result.stdout)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--output", type=pathlib.Path, required=True)
    options = parser.parse_args()
    unittest.main(argv=sys.argv[:1], verbosity=0)
