"""Which scenes a gallery shows, and the image that each is compared with."""

import dataclasses
import pathlib
import struct

from study_exr import read_header


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    path: pathlib.Path
    folder: pathlib.Path
    reference: pathlib.Path | None
    reference_size: tuple[int, int] | None


def short_name(path, folder):
    """The path without its ending; a file named like its folder goes by that name once."""
    name = path.relative_to(folder).with_suffix("")
    return str(name.parent if name.name == name.parent.name else name)


def is_scene(path):
    return path.suffix.lower() in (".gltf", ".glb") and path.is_file()


def find_reference(path, name, references):
    """An image of that name, or the only one beside a scene that is the only one there."""
    named = references and references / (name + ".exr")
    if named and named.exists():
        return named
    beside = list(path.parent.glob("*.exr"))
    return beside[0] if len(beside) == 1 and len(list(filter(is_scene, path.parent.iterdir()))) == 1 else None


def exr_size(path):
    header, _ = read_header(path.read_bytes())
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    return right - left + 1, bottom - top + 1


def fitting_size(size, width):
    """The size over the smallest whole number that divides it and makes it no wider; itself if only 1 does."""
    for divisor in range(-(-size[0] // width), size[0]):
        if size[0] % divisor == 0 and size[1] % divisor == 0:
            return size[0] // divisor, size[1] // divisor
    return size


def has_shape(size, aspect_ratio):
    """Whether a camera of this aspect ratio, if it has one, fills an image of this size; a pixel more or less is none."""
    width, height = size
    return aspect_ratio is None or abs(width - aspect_ratio * height) <= max(1, aspect_ratio)


def scenes_in(folder, references):
    for path in sorted(filter(is_scene, folder.rglob("*"))):
        name = short_name(path, folder)
        reference = find_reference(path, name, references)
        yield Scene(name, path, folder, reference, reference and exr_size(reference))


def find_scenes(folders, references):
    """Names are unique: where two scenes share one, the later goes by more of its path."""
    scenes = {}
    for folder in folders:
        for scene in scenes_in(folder, references):
            names = [scene.name, str(scene.path.relative_to(folder)), str(scene.path).lstrip("/")]
            name = next(name for name in names if name not in scenes)
            scenes[name] = dataclasses.replace(scene, name=name)
    return list(scenes.values())
