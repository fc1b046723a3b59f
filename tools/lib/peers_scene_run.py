"""One scene of `tools/bench/peers`: references of every renderer, whether they agree, then all variants in turns. What was
rendered is kept in the scene's folder, so that a run that was interrupted goes on."""

import array
import csv
import json
import math
import random
import sys
import time

from peers_errors import compare, differs, errors, halves, reference_noise
from peers_plan import levels, plan, reference_samples
from peers_renderers import REFERENCES, VARIANTS, Failed, Missing
from peers_scene import export

COLUMNS = ["variant", "seed", "checkpoint", "samples_per_pixel", "rays", "device_seconds", "wall_seconds", "setup_seconds",
           "mse", "rel_mse", "rel_mse_trimmed", "mae", "flip", "bias", "relative_rmse", "estimate"]
REPLICATES = 8  # of each renderer's reference
REFERENCE_SHARE = 0.35  # of a scene's time
ISOLUX_SHARE = 0.6  # of that: errors of all whose images are equal are taken against Isolux's
SAMPLE_BASE = {"isolux": 2, "mitsuba": 4, "cycles": 2}  # multi-jittered points want squares
PILOT = 16  # samples a pixel of the render that costs and errors are foreseen from
EQUAL = 0.005  # relative difference of means that is no difference yet
# Seeds of what must be independent lie apart.
REFERENCE_SEED, PILOT_SEED, FIRST_SEED = 1_000_000, 2_000_000, 1


def write(path, text):
    temporary = path.with_name("." + path.name)
    temporary.write_text(text)
    temporary.replace(path)


def say(text):
    print(f"peers: {text}", file=sys.stderr, flush=True)


class SceneRun:
    def __init__(self, name, path, folder, renderers, options):
        self.name, self.path, self.folder, self.renderers, self.options = name, path, folder, renderers, options
        self.missing, self.open, self.setup, self.images = {}, {}, {}, {}
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "references").mkdir(exist_ok=True)

    # --- renderers

    def started(self):
        """Every variant that can be had, warmed up: the first image compiles, and what it takes longer than the second is
        set-up."""
        for variant in VARIANTS:
            if self.options.only and variant.renderer not in ("isolux", *self.options.only):
                continue
            try:
                self.open[variant.name] = self.renderers.start(variant, self.path, self.folder)
                first, second = (self.open[variant.name].render(4, PILOT_SEED + number) for number in (1, 2))
                warm = 0.0 if variant.renderer == "isolux" else max(0.0, first.seconds - second.seconds)
                self.setup[variant.name] = second.setup + warm
            except (Missing, Failed) as error:
                if variant.renderer == "isolux":
                    raise
                self.missing[variant.name] = str(error)
                if variant.name in self.open:
                    self.open.pop(variant.name).close()
        return [variant for variant in VARIANTS if variant.name in self.open]

    def close(self):
        for renderer in self.open.values():
            renderer.close()

    # --- references

    def sources(self):
        """The variant that renders the references of each renderer that is there."""
        found = {renderer: [name for name in names if name in self.open] for renderer, names in REFERENCES.items()}
        return {renderer: names[0] for renderer, names in found.items() if names}

    def pilot(self, variants):
        """Seconds of a sample a pixel, and the image."""
        found = {}
        for variant in variants:
            render = self.open[variant.name].render(PILOT, PILOT_SEED)
            found[variant.name] = (render.seconds / PILOT, render.image)
        return found

    def reference_images(self, renderer, spp):
        found = []
        for number in range(REPLICATES):
            path = self.folder / "references" / f"{renderer}-{spp}-{number}.f32"
            if not path.exists():
                image = self.open[self.sources()[renderer]].render(spp, REFERENCE_SEED + number).image
                path.with_suffix(".part").write_bytes(image.tobytes())
                path.with_suffix(".part").replace(path)
            found.append(array.array("f", path.read_bytes()))
        return found

    def take_references(self, samples):
        for renderer, spp in samples.items():
            say(f"{self.name}: {REPLICATES} images of {spp} samples a pixel by {renderer}")
            self.images[renderer] = self.reference_images(renderer, spp)

    def equality(self, samples):
        """How each renderer's images differ from Isolux's, and against which references its errors are taken."""
        found = {}
        for renderer, images in self.images.items():
            noise = reference_noise(*halves(images))
            found[renderer] = {"samplesPerPixel": samples[renderer] * REPLICATES, "relativeRmse": noise}
            if renderer != "isolux":
                found[renderer] |= compare(images, self.images["isolux"], self.options.size)
                found[renderer]["differs"] = differs(found[renderer]["bias"], EQUAL)
        return found

    # --- times

    def prepared(self, variants):
        """What was planned once holds, because rounds and levels must fit together, unless another variant has come."""
        path = self.folder / "plan.json"
        if path.exists():
            found = json.loads(path.read_text())
            if set(found["tops"]) >= {variant.name for variant in variants}:
                return found
        pilots = self.pilot(variants)
        costs = {name: cost for name, (cost, _) in pilots.items()}
        seconds = self.options.seconds
        present = self.sources()
        share = {renderer: (1 - ISOLUX_SHARE) / max(1, len(present) - 1) for renderer in present} | {"isolux": ISOLUX_SHARE}
        samples = {renderer: reference_samples(costs[name], seconds * REFERENCE_SHARE * share[renderer], REPLICATES,
                                               SAMPLE_BASE[renderer])
                   for renderer, name in present.items()}
        self.take_references(samples)
        pairs = {renderer: halves(images) for renderer, images in self.images.items()}
        start = {variant.name: errors(pilots[variant.name][1], *pairs[variant.renderer])["relative_rmse"]
                 for variant in variants}
        tops = plan(costs, start, PILOT, seconds * (1 - REFERENCE_SHARE) / self.options.rounds, self.options.levels)
        found = {"samples": samples, "tops": tops, "costs": costs, "pilotErrors": start}
        (self.folder / "rows.csv").unlink(missing_ok=True)
        write(path, json.dumps(found, indent=1) + "\n")
        return found

    def rows_kept(self):
        path = self.folder / "rows.csv"
        if not path.exists():
            return []
        with path.open(newline="") as stream:
            return [row for row in csv.DictReader(stream) if None not in row.values()]

    def measure(self, variants, tops, references):
        """In every round all variants and levels, in random order."""
        done = {(row["variant"], int(row["seed"]), int(row["checkpoint"])) for row in self.rows_kept()}
        generator = random.Random(self.name)
        begin = time.monotonic()
        for number in range(self.options.rounds):
            todo = [(variant, level, spp) for variant in variants
                    for level, spp in enumerate(levels(tops[variant.name], self.options.levels))]
            generator.shuffle(todo)
            for variant, level, spp in todo:
                if (variant.name, number, level) not in done:
                    self.take(variant, number, level, spp, references[variant.renderer])
            say(f"{self.name}: round {number + 1} of {self.options.rounds}, {time.monotonic() - begin:.0f} s")

    def take(self, variant, number, level, spp, pair):
        """A line at once, so that nothing measured is lost. Levels of a round are independent of each other."""
        render = self.open[variant.name].render(spp, FIRST_SEED + 100 * number + level)
        if not all(map(math.isfinite, render.image)):
            raise Failed(f"{variant.name}: an image holds NaN or infinity")
        setup = render.setup if variant.renderer == "isolux" else self.setup[variant.name]
        row = {"variant": variant.name, "seed": number, "checkpoint": level, "samples_per_pixel": spp, "rays": render.rays,
               "device_seconds": render.device_seconds, "wall_seconds": render.seconds, "setup_seconds": setup,
               **errors(render.image, *pair)}
        path = self.folder / "rows.csv"
        new = not path.exists()
        with path.open("a", newline="") as stream:
            writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
            if new:
                writer.writeheader()
            writer.writerow(row)

    def complete_rows(self):
        """Of rounds that are whole, sorted: every seed of a variant has the same checkpoints."""
        rows, kept = self.rows_kept(), []
        for variant in VARIANTS:
            own = [row for row in rows if row["variant"] == variant.name]
            wanted = {row["checkpoint"] for row in own}
            seeds = [seed for seed in sorted({row["seed"] for row in own}, key=int)
                     if {row["checkpoint"] for row in own if row["seed"] == seed} == wanted]
            whole = [row for row in own if row["seed"] in seeds]
            kept += sorted(whole, key=lambda row: (int(row["seed"]), int(row["checkpoint"])))
        return kept

    def write_csv(self):
        path = self.folder / "convergence.csv"
        lines = [",".join(COLUMNS)] + [",".join(row[column] for column in COLUMNS) for row in self.complete_rows()]
        write(path, "\n".join(lines) + "\n")
        return path

    def run(self):
        """Measures what is not measured yet. Returns what was found of equality."""
        export(self.path, self.folder)
        try:
            variants = self.started()
            for name, reason in self.missing.items():
                say(f"{self.name}: without {name}: {reason}")
            found = self.prepared(variants)
            samples = {renderer: spp for renderer, spp in found["samples"].items() if renderer in self.sources()}
            if not self.images:
                self.take_references(samples)
            equality = self.equality(samples)
            write(self.folder / "equality.json", json.dumps(equality, indent=1) + "\n")
            own = {renderer: renderer if entry.get("differs") else "isolux" for renderer, entry in equality.items()}
            pairs = {renderer: halves(self.images[source]) for renderer, source in own.items()}
            if not self.options.equality:
                self.measure(variants, found["tops"], pairs)
        finally:
            self.close()
        return equality
