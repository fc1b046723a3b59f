"""What the study works with: the scenes by their part in it, how many samples each measurement may take, references."""

import dataclasses
import pathlib

from gltf_facts import facts, read_document
from study_runs import Request

# A closed box of albedos 0.2, 0.5 and 0.8 in red, green and blue, all of it emitting: paths go on for ever.
FURNACE = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "furnace" / "furnace.gltf"
FURNACE_ALBEDO = 0.8

# More bounces than this carry no light that an image here could show; the report's own largest depth.
FULL_DEPTH = 100

ABSENT = "the report's own file is not in the collection"
STAND_INS = {
    "CBdragon_standin": f"the Stanford dragon decimated to 100,000 triangles: {ABSENT}",
    "dragon_standin": f"another decimation of the Stanford dragon on the report's pedestal: {ABSENT}",
    "CBlucy_standin": f"another decimation of Stanford's Lucy: {ABSENT}",
    "bench_standin_beast": f"another mesh of about the same size, a beast: {ABSENT}",
    "blob_standin": f"a body made by a procedure, 196,608 triangles: {ABSENT}",
    "wall-e_standin_dragon202k": f"a dragon of 202,520 triangles: {ABSENT}",
}
OWN_SCENE = "of the project's own scenes: the report's are not at hand"


@dataclasses.dataclass(frozen=True)
class Scenes:
    """Files by role. `timed` is also what the chart of times goes over."""
    folder: pathlib.Path
    normals: tuple
    timed: tuple
    bunny: pathlib.Path
    spheres: pathlib.Path
    dragon: pathlib.Path
    gallery: tuple
    own: bool

    def stand_in(self, path):
        """Why the scene is not the report's, or None."""
        return OWN_SCENE if self.own else STAND_INS.get(path.stem)


def seed_scenes(folder):
    def files(names):
        return tuple(folder / f"{name}.glb" for name in names.split())

    normals = files("CBempty CBspheres_lambertian banana teapot cow CBlucy_standin blob_standin maxplanck")
    timed = files("CBempty CBgems banana cow beetle CBbunny CBspheres_lambertian maxplanck bench_standin_beast "
                  "CBlucy_standin blob_standin wall-e_standin_dragon202k")
    bunny, spheres, dragon = files("CBbunny CBspheres_lambertian dragon_standin")
    gallery = files("bunny dragon_standin blob_standin bench_standin_beast")
    return Scenes(folder, normals, timed, bunny, spheres, dragon, gallery, False)


def own_scenes(folder):
    box, spheres, courtyard, furnace = (folder / name / f"{name}.gltf"
                                        for name in ("cornell_box", "cornell_spheres", "courtyard", "furnace"))
    return Scenes(folder, (box, spheres, courtyard), (furnace, box), box, spheres, courtyard, (box, courtyard), True)


def find_scenes(folder):
    """The report's scenes, or the project's own; None if the folder holds neither."""
    if (folder / "CBbunny.glb").is_file():
        return seed_scenes(folder)
    if (folder / "cornell_box" / "cornell_box.gltf").is_file():
        return own_scenes(folder)
    return None


@dataclasses.dataclass(frozen=True)
class Effort:
    """Sizes of images, samples a pixel, seeds."""
    size: tuple = (108, 108)
    seeds: int = 16
    normals_spp: int = 16
    timing_size: tuple = (64, 48)
    timing_repeats: int = 3
    timing_seconds: float = 0.4
    light_spp: int = 8
    light_depths: tuple = (1, FULL_DEPTH)
    light_samples: tuple = (1, 4, 16, 64)
    bounce_spp: int = 16
    roulette_spp: int = 4
    roulette_depths: tuple = (0, 1, 2, 3, 4, FULL_DEPTH)
    furnace_depths: tuple = (1, 2, 4, 8, 12, 16)
    furnace_spp: int = 512
    ladder: tuple = (1, 2, 4, 8, 16, 64, 1024)
    ladder_samples: int = 512  # a pixel in all for each step of the ladder: fewer seeds where there are many samples
    tolerances: tuple = (0.2, 0.1, 0.05, 0.02)
    adaptive_size: tuple = (80, 80)
    adaptive_max: int = 1024
    adaptive_seeds: int = 4
    gallery_spp: int = 32
    reference_spp: int = 512
    long_reference_spp: int = 2048
    adaptive_reference_spp: int = 4096


REDUCED = Effort(size=(32, 32), seeds=3, normals_spp=4, timing_size=(16, 12), timing_repeats=1, timing_seconds=0.05,
                 light_spp=4, light_depths=(FULL_DEPTH,), light_samples=(1, 4), bounce_spp=8, roulette_spp=4,
                 roulette_depths=(2, FULL_DEPTH), furnace_depths=(2, 8), furnace_spp=128, ladder=(1, 4, 16, 64), ladder_samples=192, tolerances=(0.2,),
                 adaptive_size=(32, 32), adaptive_max=512, adaptive_seeds=2, gallery_spp=4, reference_spp=128,
                 long_reference_spp=1024, adaptive_reference_spp=1024)


class Study:
    """What every part of the study is given."""

    def __init__(self, runner, scenes, effort):
        self.runner = runner
        self.scenes = scenes
        self.effort = effort

    def request(self, scene, options, spp, **more):
        return Request(scene, tuple(options), spp, more.pop("size", self.effort.size), **more)

    def seeds(self, scene, options, spp, count=None, **more):
        return [self.request(scene, options, spp, seed=seed, **more) for seed in range(count or self.effort.seeds)]

    def reference(self, scene, options, spp=None, **more):
        """Independent of every image: a seed of its own. Sobol points, because their variance is less and known."""
        options = [*options, "--pixel-sampler", "sobol"]
        return self.runner.reference(self.request(scene, options, spp or self.effort.reference_spp, seed=1 << 32, **more))

    def depth_reference(self, scene, bounces, **more):
        """Those of all bounces and of direct light alone serve the most figures, so they are longer."""
        spp = self.effort.long_reference_spp if bounces in (1, FULL_DEPTH) else self.effort.reference_spp
        return self.reference(scene, depth(bounces), spp, **more)

    def picture(self, run, label, compared=None, image=None):
        """An image of the page, with its error unless the image shows no light."""
        error = compared and compared.whole
        return {
            "label": label,
            "image": str((image or run.png).relative_to(self.runner.output)),
            "scene": run.request.scene.stem,
            "standIn": self.scenes.stand_in(run.request.scene),
            "spp": run.spp,
            "seconds": run.seconds,
            "relativeRmse": error and error.relative_rmse,
            "surfaceRmse": compared and compared.surfaces and compared.surfaces.relative_rmse,
            "flagged": bool(error) and error.flagged,
            "referenceShare": error and error.mse and error.reference_variance / error.mse,
            "command": run.request.command(),
        }

    def pictures(self, measured):
        """The first seed of each, by name."""
        return [self.picture(one.runs[0], name, one.compared[0]) for name, one in measured.items()]


def depth(bounces):
    return ["--max-depth", str(bounces)]


def depth_name(bounces):
    return "direct light" if bounces == 1 else "all bounces" if bounces == FULL_DEPTH else f"{bounces} bounces"


def triangle_count(scene):
    return facts(scene)["triangles"]


def largest_albedo(scene):
    """The largest channel of any material's base colour. A material without one is white (glTF 2.0, 5.22.1)."""
    colors = [material.get("pbrMetallicRoughness", {}).get("baseColorFactor", [1.0] * 4)
              for material in read_document(scene).get("materials", [{}])]
    return max(max(color[:3]) for color in colors)
