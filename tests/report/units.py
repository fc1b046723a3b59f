"""What tools/report says of a run, without matplotlib: reading, sentences, warnings, ratios, numbers as text."""

import copy
import json
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tools" / "lib"), str(pathlib.Path(__file__).parent)]
sys.dont_write_bytecode = True
import report_data
import report_figures
import report_tables
import report_text
import synthetic


class WithRuns(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.kept.name)
        cls.reports = synthetic.write_all(cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def read(self, *names):
        return report_data.read_runs([self.folder / name for name in names])

    def refused(self, text):
        """What is said of such a file."""
        folder = self.folder / "bad"
        folder.mkdir(exist_ok=True)
        (folder / "convergence.json").write_text(text)
        with self.assertRaises(report_data.BadInput) as caught:
            report_data.read_runs([folder])
        said = str(caught.exception)
        self.assertEqual(len(said.splitlines()), 1)
        self.assertIn("bad/convergence.json", said)
        return said


class Reading(WithRuns):
    def test_figures_come_as_they_are_written(self):
        run, = self.read("cornell")
        written = self.reports["cornell"]["variants"]
        self.assertEqual([one["name"] for one in run.variants], [one["name"] for one in written])
        self.assertEqual(run.variants[2]["checkpoints"][3]["relativeRmse"], written[2]["checkpoints"][3]["relativeRmse"])

    def test_unknown_is_none(self):
        run, = self.read("fitted")
        self.assertIsNone(run.data["images"])
        self.assertIsNone(run.variants[0]["checkpoints"][0]["estimate"])
        self.assertIsNone(report_figures.facts(run)["Device"])

    def test_titles_are_apart(self):
        folders = [self.folder / "cornell", self.folder / "blob", self.folder / "cornell"]
        runs = report_data.read_runs(folders)
        self.assertEqual(len({run.title for run in runs}), 3)
        self.assertEqual(len({run.slug for run in runs}), 3)

    def test_no_file_is_said(self):
        with self.assertRaisesRegex(report_data.BadInput, "nowhere/convergence.json: No such file"):
            self.read("nowhere")

    def test_what_is_no_report_is_refused(self):
        self.assertIn("damaged JSON", self.refused('{"schema": 1, "kind": "conv'))
        self.assertIn("damaged JSON", self.refused("[" * 100000))
        self.assertIn("not a convergence report", self.refused("[1, 2]"))
        self.assertIn("not a convergence report", self.refused('{"kind": "render", "schema": 1}'))
        self.assertIn("schema 2, only 1", self.refused('{"kind": "convergence", "schema": 2, "variants": []}'))
        self.assertIn("no variants", self.refused('{"kind": "convergence", "schema": 1, "variants": []}'))

    def test_the_place_of_a_fault_is_named(self):
        def broken(change):
            report = copy.deepcopy(self.reports["blob"])
            change(report)
            return self.refused(json.dumps(report))

        self.assertIn("variants[1].checkpoints[2] has no 'wallSeconds'",
                      broken(lambda report: report["variants"][1]["checkpoints"][2].pop("wallSeconds")))
        self.assertIn("variants[0].checkpoints[0].wallSeconds wants a number above 0",
                      broken(lambda report: report["variants"][0]["checkpoints"][0].update(wallSeconds=0)))
        self.assertIn("variants[0].slopeTime wants [low, estimate, high]",
                      broken(lambda report: report["variants"][0].update(slopeTime=[1])))
        self.assertIn("ratios[0].ratio wants a number",
                      broken(lambda report: report["ratios"][0].update(ratio=[1, "2", 3])))
        self.assertIn("variants[0].name wants a text", broken(lambda report: report["variants"][0].update(name=3)))


class Figures(WithRuns):
    def test_the_best_is_the_soonest(self):
        run, = self.read("cornell")
        for error in run.data["errors"]:
            times = [report_figures.time_to(variant, error)["seconds"][1] for variant in run.variants]
            self.assertEqual(report_figures.best(run, error), times.index(min(times)))

    def test_headlines_are_the_reports_own_sentences(self):
        run, = self.read("cornell")
        found = report_figures.headlines(run)
        texts = {ratio["text"] for ratio in self.reports["cornell"]["ratios"]}
        self.assertEqual(len(found), 5)
        for line in found:
            self.assertIn(line.removesuffix(" (extrapolated)"), texts)

    def test_ratio_that_may_be_one_is_said_so(self):
        ratio = {"faster": "a", "slower": "b", "error": 0.05, "ratio": [0.9, 1.1, 1.3], "extrapolated": False, "text": None}
        self.assertIn("the interval holds 1", report_figures.sentence(ratio))
        self.assertIn("a reaches 5\u00a0% relative RMSE 1.10 (0.900–1.30) times sooner than b", report_figures.sentence(ratio))

    def test_ratios_are_inverted_with_their_interval(self):
        ratios = [{"faster": "a", "slower": "b", "ratio": [2.0, 4.0, 5.0], "extrapolated": True}]
        self.assertEqual(report_tables.directed(ratios, "b", "a"), ([0.2, 0.25, 0.5], True))
        self.assertEqual(report_tables.directed(ratios, "a", "c"), (None, False))

    def test_outside_means_the_whole_interval(self):
        limits = report_figures.COVERAGE_LIMITS
        self.assertEqual(report_figures.outside([0.90, 0.92, 0.94], limits), "")
        self.assertEqual(report_figures.outside([0.90, 0.91, 0.92], limits), "below")
        self.assertEqual(report_figures.outside([0.98, 0.99, 1.0], limits), "above")
        self.assertEqual(report_figures.outside([None, 0.5, None], limits), "")

    def test_everything_to_warn_of_is_warned_of(self):
        said = "\n".join(report_figures.warnings(self.read("faulty")[0]))
        for words in ("too noisy for the errors of mis@9", "12 samples NaN or infinite", "345 samples clamped",
                      "clamped: the error ends at a floor of 3", "mis-flip.png is missing", "miscalibrated"):
            self.assertIn(words, said)
        self.assertNotIn("light:", said)

    def test_nothing_wrong_nothing_said(self):
        said = [line for line in report_figures.warnings(self.read("blob")[0]) if "miscalibrated" not in line]
        self.assertEqual(said, [])


class Text(unittest.TestCase):
    def test_ticks_are_plain(self):
        for value, shown in {0.001: "0.001", 0.02: "0.02", 1.0: "1", 1000.0: "1,000", -0.5: "−0.5"}.items():
            self.assertEqual(report_text.plain_number(value), shown)
        self.assertEqual(report_text.plain_percent(0.002), "0.2\u00a0%")
        self.assertEqual(report_text.plain_percent(0.07), "7\u00a0%")

    def test_intervals(self):
        self.assertEqual(report_text.with_interval([1.25, 2.5, 3.75]), ("2.50", "1.25 to 3.75"))
        self.assertEqual(report_text.with_interval([None, 2.5, None]), ("2.50", ""))
        self.assertEqual(report_text.with_interval(None), ("–", ""))

    def test_inverse(self):
        self.assertEqual(report_text.inverse([1, 2, 4]), [0.25, 0.5, 1])
        self.assertIsNone(report_text.inverse([-1, 2, 4]))

    def test_clock(self):
        self.assertEqual([re.sub("\u00a0", " ", report_text.clock(value)) for value in (1.25, 150.0, 9000.0, None)],
                         ["1.25 s", "2.50 min", "2.50 h", "–"])


if __name__ == "__main__":
    unittest.main(verbosity=0)
