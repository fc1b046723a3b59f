"""The study's arithmetic and its page, without the program: statistics against tables, numbers as text, charts."""

import math
import pathlib
import random
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "lib"))
sys.dont_write_bytecode = True
import study_chart
import study_exr
import study_page
import study_runs
import study_statistics
import study_text


class Statistics(unittest.TestCase):
    def test_student_quantiles_are_those_of_tables(self):
        """Abramowitz and Stegun (1964), table 26.10; the series is good to 0.2 % from 3 degrees of freedom on."""
        for freedom, quantile in {1: 12.706, 2: 4.3027, 3: 3.1824, 5: 2.5706, 15: 2.1314, 30: 2.0423}.items():
            self.assertAlmostEqual(study_statistics.t_quantile(freedom) / quantile, 1.0, delta=0.002)

    def test_interval_of_a_mean(self):
        low, mean, high = study_statistics.mean_interval([1.0, 2.0, 3.0])
        self.assertEqual(mean, 2.0)
        self.assertAlmostEqual(high - mean, 4.3027 / math.sqrt(3), places=3)
        self.assertAlmostEqual(mean - low, high - mean)
        self.assertEqual(study_statistics.mean_interval([5.0]), [None, 5.0, None])

    def test_slope_of_exact_errors(self):
        counts = [1, 4, 16]
        slope, line = study_statistics.log_log_slope(counts, [[4.0 / n, 4.0 / n] for n in counts])
        self.assertTrue(all(abs(value + 0.5) < 1e-12 for value in slope))
        self.assertAlmostEqual(line[0], 2.0)

    def test_inefficiency_is_the_ratio_of_error_times_time(self):
        low, ratio, high = study_statistics.inefficiency_ratio([8.0, 8.0], [1.0, 1.0], [2.0, 2.0], [2.0, 2.0])
        self.assertEqual((low, ratio, high), (2.0, 2.0, 2.0))

    def test_bootstrap_interval_covers(self):
        """Of 100 intervals for a mean of 16 values about 90 % or more hold it (percentile intervals are a little short);
        fewer than 80 has a probability below 0.2 % at 90 %."""
        generator, inside = random.Random(5), 0
        for _ in range(100):
            values = [generator.gauss(3.0, 1.0) for _ in range(16)]
            low, _, high = study_statistics.bootstrap(lambda samples: sum(samples[0]) / len(samples[0]), [values])
            inside += low <= 3.0 <= high
        self.assertGreaterEqual(inside, 80)

    def test_noise_is_subtracted_and_never_clamped(self):
        error = study_runs.Error(raw_mse=0.5, reference_variance=0.54, reference_mean=2.0)
        self.assertAlmostEqual(error.relative_rmse, -0.1)
        self.assertTrue(error.flagged)
        self.assertFalse(study_runs.Error(1.0, 0.009, 2.0).flagged)


class Text(unittest.TestCase):
    def test_numbers(self):
        for value, shown in {0.0: "0", 1363.4: "1,363", 0.0123: "0.0123", 4.0: "4", -0.5: "−0.500", 12.34: "12.3"}.items():
            self.assertEqual(study_text.number(value), shown)
        self.assertEqual(study_text.number(5.01e-6), "5.01\u00a0×\u00a010⁻⁶")
        self.assertEqual(study_text.number(None), "–")

    def test_intervals(self):
        self.assertEqual(study_text.interval([1.0, 2.0, 3.0]), "2 [1,\u00a03]")
        self.assertEqual(study_text.interval([None, 2.0, None]), "2")


class Page(unittest.TestCase):
    def test_chart_has_ticks_and_leaves_out_what_has_no_logarithm(self):
        block = study_text.chart_block("c", "x", "y", [study_text.series("a", [[1, 2.0], [10, -1.0], [100, 0.5]])])
        drawn = study_chart.chart(block)
        self.assertEqual(drawn.count("<title>"), 2)
        self.assertGreaterEqual(drawn.count('class="grid"'), 4)

    def test_what_was_measured_is_escaped(self):
        table = study_text.table_block("a < b", ["<"], [["<script>"]], ["x < y"])
        shown = study_page.KINDS["table"](table, pathlib.Path())
        self.assertNotIn("<script>", shown)
        self.assertIn("x &lt; y", shown)


class Exr(unittest.TestCase):
    def test_predicted_and_interleaved_bytes_come_back(self):
        """The inverse of what the format's zip compression does before deflating."""
        import zlib
        plain = bytes(random.Random(1).randrange(256) for _ in range(101)) + bytes(100)
        split = plain[0::2] + plain[1::2]
        coded = bytes([split[0]] + [(b - a + 128) & 255 for a, b in zip(split, split[1:])])
        self.assertEqual(study_exr.unpacked(zlib.compress(coded), len(plain)), plain)


if __name__ == "__main__":
    unittest.main(verbosity=0)
