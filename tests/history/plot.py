"""The plot of tools/bench/history: files that are whole, with every run, machine and mode in them."""

import importlib.util
import os
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from made_runs import run

SYSTEM_PYTHON = "/usr/bin/python3"  # what the system's packages belong to, where another one comes first

if not all(importlib.util.find_spec(name) for name in ("matplotlib", "numpy")):
    if os.path.exists(SYSTEM_PYTHON) and "--again" not in sys.argv:
        os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, __file__, "--again"])
    print("matplotlib or numpy is missing: tools/packages --install report")
    sys.exit(77)
import history_plot

SVG = "{http://www.w3.org/2000/svg}"


class Plot(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.kept.name)

    def tearDown(self):
        self.kept.cleanup()

    def draw(self, runs):
        return history_plot.draw(runs, self.folder / "history")

    def texts(self, svg):
        root = xml.etree.ElementTree.parse(svg).getroot()
        return [element.text for element in root.iter(SVG + "text")]

    def test_both_files_are_whole(self):
        svg, png = self.draw([run(0), run(1, factor=1.2), run(2, cpu="another")])
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["history.png", "history.svg"])
        self.assertTrue(png.read_bytes().startswith(b"\x89PNG") and png.read_bytes().endswith(b"IEND\xaeB`\x82"))
        found = self.texts(svg)
        for words in ("rays", "build", "path", "error", "abcdef", "2026-01-03", "A CPU, 4 cores; a device",
                      "another, 4 cores; a device"):
            self.assertIn(words, found)

    def test_the_same_runs_give_the_same_file(self):
        first = self.draw([run(0), run(1)])[0].read_bytes()
        self.assertEqual(self.draw([run(0), run(1)])[0].read_bytes(), first)

    def test_light_and_dark(self):
        text = self.draw([run(0)])[0].read_text()
        self.assertIn("@media (prefers-color-scheme: dark) { :root { --", text)
        self.assertIn("var(--card)", text)
        self.assertNotIn("#fffffe", text.split("</style>", 1)[1])

    def test_what_is_missing_leaves_a_gap(self):
        lacking = run(1)
        lacking["ratios"]["error"] = None
        lacking["ratios"]["build"] = {"rounds": [0.2], "interval": [None, 0.2, None]}
        self.draw([run(0), lacking, run(2)])
        self.assertEqual(len(history_plot.points([run(0), lacking], history_plot.machines_of([lacking])[0], "error")), 1)

    def test_many_runs_keep_few_labels(self):
        found = self.texts(self.draw([run(number) for number in range(28)])[0])
        dates = [text for text in found if text and text.startswith("2026")]
        self.assertLessEqual(len(dates), 4 * history_plot.MOST_LABELS)

    def test_quick_runs_are_left_out_where_there_are_others(self):
        self.assertEqual(history_plot.shown([run(0), run(1, quick=True)]), [run(0)])
        self.assertEqual(len(history_plot.shown([run(1, quick=True)])), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=0)
