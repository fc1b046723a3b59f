"""What tools/bench/history computes, keeps and says, on runs that are made up."""

import json
import multiprocessing
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from made_runs import ROOT, raw_round, run
import history_compare
import history_file
import history_measure

HISTORY = ROOT / "tools" / "bench" / "history"


def append_many(path, writer):
    for number in range(20):
        history_file.append(path, run(number, cpu=f"writer {writer} " + "x" * 5000))


class WithFile(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.kept.name) / "deep" / "history.jsonl"

    def tearDown(self):
        self.kept.cleanup()

    def append(self, *runs):
        for one in runs:
            history_file.append(self.path, one)

    def call(self, *options):
        return subprocess.run([sys.executable, str(HISTORY), "--file", str(self.path), *options], capture_output=True,
                              text=True)


class Arithmetic(unittest.TestCase):
    def test_ratios_are_those_of_the_definition(self):
        self.assertEqual(history_measure.ratios_of(raw_round()), {"rays": 0.5, "build": 0.25, "path": 0.1, "error": 2.0})

    def test_more_is_better_in_all(self):
        usual, faster = history_measure.ratios_of(raw_round()), history_measure.ratios_of(raw_round(factor=2.0))
        for name in history_file.RATIOS:
            self.assertAlmostEqual(faster[name], 2 * usual[name])

    def test_medians_and_intervals_of_the_rounds(self):
        found = run()
        self.assertEqual(found["rounds"], 7)
        self.assertEqual(found["raw"]["raysPerSecond"], 4e6)
        low, median, high = found["ratios"]["rays"]["interval"]
        self.assertEqual(median, 0.5)
        self.assertTrue(0.5 * 0.97 <= low < median < high <= 0.5 * 1.03)

    def test_time_to_an_error_follows_the_square(self):
        point = {"wallSeconds": 3.0, "relativeRmse": [0.09, 0.1, 0.11]}
        report = {"variants": [{"checkpoints": [{"wallSeconds": 1.0, "relativeRmse": None}, point]}]}
        self.assertAlmostEqual(history_measure.seconds_to_error(report), 12.0)
        point["relativeRmse"] = [None, -0.1, None]
        with self.assertRaises(history_measure.Failed):
            history_measure.seconds_to_error(report)

    def test_rates_are_the_devices_own(self):
        report = {"rays": 100, "seconds": {"device": 4.0, "render": 5.0}}
        self.assertEqual(history_measure.device_rate(report, "rays"), 25.0)
        report["seconds"]["device"] = None
        self.assertEqual(history_measure.device_rate(report, "rays"), 20.0)


class Comparing(unittest.TestCase):
    def test_a_change_is_found_and_so_is_none(self):
        for factor, said in ((1.5, "better, beyond noise"), (0.7, "worse, beyond noise"), (1.0, "within noise")):
            before, after = run(0), run(1, factor=factor)
            for name in history_file.RATIOS:
                found = history_compare.change(before["ratios"][name], after["ratios"][name])
                self.assertAlmostEqual(found[1], factor)
                self.assertEqual(history_compare.verdict(found), said)

    def test_only_runs_of_the_same_machine_and_length(self):
        runs = [run(0), run(1), run(2, cpu="another"), run(3, quick=True), run(4)]
        before, last = history_compare.last_two(runs)
        self.assertEqual((before["date"], last["date"]), (runs[1]["date"], runs[4]["date"]))
        self.assertIsNone(history_compare.last_two(runs[:3])[0])

    def test_what_is_missing_is_not_compared(self):
        self.assertIsNone(history_compare.change(None, run()["ratios"]["rays"]))
        self.assertEqual(history_compare.verdict([None, 2.0, None]), "one round: no interval")

    def test_doubts_are_said(self):
        few = history_compare.comparison(run(0, rounds=2), run(1, scenes={"rays": "2"}, dirty=True))
        for words in ("fewer than five rounds", "the scenes are not the same", "abcdf0+"):
            self.assertIn(words, few)


class File(WithFile):
    def test_what_is_written_is_read(self):
        runs = [run(0), run(1, cpu="Ein Prozessor mit Umläuten")]
        self.append(*runs)
        self.assertEqual(history_file.read(self.path), (runs, []))

    def test_no_file_has_no_runs(self):
        self.assertEqual(history_file.read(self.path), ([], []))

    def test_damaged_lines_are_named_and_kept(self):
        self.append(run(0))
        bad = [b'{"schema": 1, "date', b"\xff\xfe", b"[" * 100000, b'{"schema": 2}', b"[]",
               json.dumps(run(1, ratios={"rays": {"rounds": [0], "interval": [1, 1, 1]}})).encode(),
               json.dumps(run(1, machine="?")).encode()]
        kept = self.path.read_bytes() + b"\n".join(bad) + b"\n"
        self.path.write_bytes(kept)
        self.append(run(2))
        self.assertTrue(self.path.read_bytes().startswith(kept))
        runs, damaged = history_file.read(self.path)
        self.assertEqual([one["date"][8:10] for one in runs], ["01", "03"])
        self.assertEqual([number for number, _ in damaged], [2, 3, 4, 5, 6, 7, 8])
        self.assertIn("rays.rounds wants numbers above 0", damaged[5][1])

    def test_a_torn_line_does_not_spoil_the_next(self):
        self.append(run(0))
        torn = self.path.read_bytes() + b'{"schema": 1, "da'
        self.path.write_bytes(torn)
        self.append(run(1))
        self.assertTrue(self.path.read_bytes().startswith(torn + b"\n"))
        runs, damaged = history_file.read(self.path)
        self.assertEqual((len(runs), [number for number, _ in damaged]), (2, [2]))

    def test_writers_at_once_lose_nothing(self):
        writers = [multiprocessing.Process(target=append_many, args=(self.path, number)) for number in range(4)]
        for writer in writers:
            writer.start()
        for writer in writers:
            writer.join()
        runs, damaged = history_file.read(self.path)
        self.assertEqual((len(runs), damaged), (80, []))

    def test_numbers_that_are_none_are_not_written(self):
        with self.assertRaises(ValueError):
            self.append(run(0, raw={"raysPerSecond": float("nan")}))
        self.assertEqual(history_file.read(self.path), ([], []))


class Command(WithFile):
    def test_compare_says_what_changed(self):
        self.append(run(0), run(1, factor=1.5))
        result = self.call("--compare")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(result.stdout.count("better, beyond noise"), 4)

    def test_compare_without_two_runs_is_refused_in_a_line(self):
        self.assertEqual(self.call("--compare").returncode, 2)
        self.append(run(0))
        result = self.call("--compare")
        self.assertEqual((result.returncode, len(result.stderr.splitlines())), (2, 1))

    def test_damaged_lines_are_said(self):
        self.append(run(0), run(1))
        with open(self.path, "a") as stream:
            stream.write("?\n")
        result = self.call("--compare")
        self.assertEqual(result.returncode, 0)
        self.assertIn("line 3: damaged JSON; left as it is", result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=0)
