"""Reading and checking capture.json; every error names file, field and value."""

import json
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from string import Formatter
from typing import Any

import numpy as np

from mua.arguments import PathLike, as_path, describe, finite_array
from mua.arrays import Array
from mua.capture.camera import COEFFICIENTS, UNDISTORTED, CaptureCamera
from mua.capture.capture import FORMAT, FRAME, VERSION, Capture, CaptureClip
from mua.characters.figure_size import LEAST, MOST
from mua.errors import InputError
from mua.files.inputs import CAPTURE, require_capture, require_file
from mua.limits import LARGEST_RATE, LEAST_RATE

LARGEST_SIDE = 1 << 15  # pixels
MOST_TRIMMED = 32  # pixels; wider ones have lost the person's shape
ROTATION_BOUND = 1e-3  # what rounding to four digits leaves of a rotation
PLACES = {  # what each pattern may name
    "images": ("clip", "camera", "frame"),
    "masks": ("clip", "camera", "frame"),
    "backgrounds": ("camera",),
    "meshes": ("clip", "frame"),
    "tracks": ("clip",),
    "tracks_2d": ("clip", "camera"),
}
OF_WHOLE_CLIPS = ("tracks", "tracks_2d")  # whose first frame is that of the clip
NEEDED = ("format", "version", "name", "rate", "template", "clips", "images", "cameras")
OPTIONAL = ("masks", "trim_masks", "backgrounds", "meshes", "tracks", "tracks_2d", "template_height", "leave_out")


def open_capture(folder: PathLike) -> Capture:
    """Read the capture.json of a folder.

    Images are not opened yet. Errors: InputError with one sentence that names file, field and value where anything
    that it says cannot be, or where the template or a motion that it names is not there.
    """
    require_capture(path := as_path(folder, "capture"))
    file = path / CAPTURE
    fields = _object(_parsed(file), str(file), NEEDED, OPTIONAL)
    if fields["format"] != FORMAT or fields["version"] != VERSION:
        found = f"{describe(fields['format'])}, version {describe(fields['version'])}"
        raise InputError(f"{file}: format is {found}; this program reads {FORMAT!r}, version {VERSION}")
    capture = Capture(
        folder=file.parent,
        name=_name(fields["name"], f"{file}: name"),
        rate=_number(fields["rate"], f"{file}: rate", LEAST_RATE, LARGEST_RATE, "frames per second"),
        template=file.parent / _text(fields["template"], f"{file}: template"),
        template_height=_height(fields.get("template_height"), f"{file}: template_height"),
        leave_out=_texts(fields.get("leave_out", []), f"{file}: leave_out"),
        clips=tuple(_clip(clip, f"{file}: clips[{i}]", file) for i, clip in enumerate(_list(fields, "clips", file))),
        cameras=tuple(_camera(one, f"{file}: cameras[{i}]") for i, one in enumerate(_list(fields, "cameras", file))),
        images=_text(fields["images"], f"{file}: images"),
        trim_masks=_count(fields.get("trim_masks", 0), f"{file}: trim_masks", 0, most=MOST_TRIMMED),
        **{
            field: _text(fields[field], f"{file}: {field}") for field in PLACES if field != "images" and field in fields
        },
    )
    _check_whole(capture)
    return capture


def _parsed(file: Path) -> Any:
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{file}: cannot be read as JSON: {error}") from error


def _check_whole(capture: Capture) -> None:
    """Checks of fields against each other."""
    for field, listed in (("cameras", capture.cameras), ("clips", capture.clips)):
        names = [one.name for one in listed]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise InputError(f"{capture.file}: {field}: two are called {twice!r}, expected a name for each")
    counts = {
        "clip": len(capture.clips) if _share_numbers(capture.clips) else 1,
        "camera": len(capture.cameras),
        "frame": 1,
    }
    for field, places in PLACES.items():
        if getattr(capture, field) is not None:
            own = {**counts, "clip": len(capture.clips)} if field in OF_WHOLE_CLIPS else counts
            _check_pattern(getattr(capture, field), f"{capture.file}: {field}", places, own)
    if capture.meshes is not None and FRAME not in capture.meshes:
        raise InputError(f"{capture.file}: meshes is {capture.meshes!r}; expected a file for each {{frame}}")
    require_file(capture.template)
    for clip in capture.clips:
        require_file(clip.motion)


def _share_numbers(clips: Sequence[CaptureClip]) -> bool:
    """Whether a number of a frame belongs to several clips, so that their files need names of their own."""
    ordered = sorted(clips, key=lambda clip: clip.first_image)
    return any(b.first_image < a.first_image + a.frames for a, b in pairwise(ordered))


def _check_pattern(pattern: str, where: str, places: Sequence[str], counts: dict[str, int]) -> None:
    try:
        named = {name for _, name, _, _ in Formatter().parse(pattern) if name is not None}
        pattern.format(**dict.fromkeys(places, "") | ({"frame": 0} if "frame" in places else {}))
    except (ValueError, KeyError, IndexError) as error:
        listed = " and ".join(f"{{{place}}}" for place in places)
        raise InputError(f"{where} is {pattern!r}; expected a path with {listed} and no other braces") from error
    for place in places:
        if place not in named and counts[place] > 1:
            raise InputError(f"{where} is {pattern!r}; expected {{{place}}} in it: there are {counts[place]}")


def _clip(value: Any, where: str, file: Path) -> CaptureClip:
    fields = _object(value, where, ("name", "motion", "frames"), ("first", "first_image", "held_out"))
    name = _name(fields["name"], f"{where}: name")
    where = f"{where} ({name})"
    return CaptureClip(
        name=name,
        motion=file.parent / _text(fields["motion"], f"{where}: motion"),
        first=_count(fields.get("first", 0), f"{where}: first", 0),
        frames=_count(fields["frames"], f"{where}: frames", 1),
        held_out=_flag(fields.get("held_out", False), f"{where}: held_out"),
        first_image=_count(fields.get("first_image", 0), f"{where}: first_image", 0),
    )


def _camera(value: Any, where: str) -> CaptureCamera:
    fields = _object(value, where, ("name", "size", "focal", "centre", "world_to_camera"), ("distortion", "held_out"))
    name = _name(fields["name"], f"{where}: name")
    where = f"{where} ({name})"
    size = finite_array(fields["size"], f"{where}: size", (2,))
    if (size != np.rint(size)).any() or (size < 1).any() or (size > LARGEST_SIDE).any():
        raise InputError(f"{where}: size is {fields['size']}; expected width and height, 1 to {LARGEST_SIDE} pixels")
    focal = finite_array(fields["focal"], f"{where}: focal", (2,))
    if (focal <= 0).any():
        raise InputError(f"{where}: focal is {fields['focal']}; expected two lengths above 0, in pixels")
    column, row = finite_array(fields["centre"], f"{where}: centre", (2,))
    return CaptureCamera(
        name=name,
        size=(int(size[0]), int(size[1])),
        focal=(float(focal[0]), float(focal[1])),
        centre=(float(column), float(row)),
        world_to_camera=_rigid(fields["world_to_camera"], f"{where}: world_to_camera"),
        distortion=_distortion(fields.get("distortion", UNDISTORTED), f"{where}: distortion"),
        held_out=_flag(fields.get("held_out", False), f"{where}: held_out"),
    )


def _rigid(value: Any, where: str) -> Array:
    """A rotation and a translation [4, 4]."""
    matrix = finite_array(value, where, (4, 4))
    if not np.array_equal(matrix[3], [0, 0, 0, 1]):
        raise InputError(f"{where}: the last row is {matrix[3].tolist()}; expected 0, 0, 0, 1 (rows of the matrix)")
    turn = matrix[:3, :3]
    if np.abs(turn @ turn.T - np.eye(3)).max() > ROTATION_BOUND:
        lengths = ", ".join(f"{length:.4g}" for length in np.linalg.norm(turn, axis=1))
        raise InputError(f"{where}: not a rotation: its rows have lengths {lengths} or are not at right angles")
    if np.linalg.det(turn) < 0:
        raise InputError(f"{where}: it mirrors (determinant -1); expected x to the right, y down and z forward")
    return matrix


def _distortion(value: Any, where: str) -> tuple[float, ...]:
    model = f"OpenCV's {', '.join(COEFFICIENTS)}"
    if isinstance(value, list) and len(value) not in (0, 4, len(COEFFICIENTS)):
        raise InputError(
            f"{where}: has {len(value)} coefficients; expected {model}; undistort the images of other models first"
        )
    given = finite_array(value or UNDISTORTED, where, (None,))
    return (*given.tolist(), *UNDISTORTED[len(given) :])


def _object(value: Any, where: str, needed: Sequence[str], optional: Sequence[str]) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise InputError(f"{where}: is {describe(value)}; expected a JSON object")
    for field in needed:
        if field not in value:
            raise InputError(f"{where}: holds no {field}; expected {', '.join(needed)}")
    for field in value:
        if field not in (*needed, *optional):
            raise InputError(f"{where}: {field!r} is no field; there are {', '.join((*needed, *optional))}")
    return value


def _list(fields: dict[str, Any], field: str, file: Path) -> list[Any]:
    value = fields[field]
    if not isinstance(value, list) or not value:
        raise InputError(f"{file}: {field} is {describe(value)}; expected a list of at least one")
    return value


def _text(value: Any, where: str) -> str:
    if not isinstance(value, str) or not value or "\0" in value:
        raise InputError(f"{where} is {describe(value)}; expected a text")
    return value


def _texts(value: Any, where: str) -> tuple[str, ...]:
    if not isinstance(value, list):
        raise InputError(f"{where} is {describe(value)}; expected a list of names")
    return tuple(_text(one, where) for one in value)


def _name(value: Any, where: str) -> str:
    """A name that may become part of a file's name."""
    if set("/\\") & set(_text(value, where)) or value in (".", ".."):
        raise InputError(f"{where} is {describe(value)}; expected a name that can be that of a folder")
    return str(value)


def _flag(value: Any, where: str) -> bool:
    if not isinstance(value, bool):
        raise InputError(f"{where} is {describe(value)}; expected true or false")
    return value


def _count(value: Any, where: str, least: int, most: int | None = None) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or value < least:
        raise InputError(f"{where} is {describe(value)}; expected a whole number of at least {least}")
    if most is not None and value > most:
        raise InputError(f"{where} is {value}; expected at most {most} pixels")
    return value


def _number(value: Any, where: str, least: float, most: float, unit: str) -> float:
    given = float(finite_array(value, where, ()))
    if not least <= given <= most:
        raise InputError(f"{where} is {given:g}; expected {least:g} to {most:g} {unit}")
    return given


def _height(value: Any, where: str) -> float | None:
    return None if value is None else _number(value, where, LEAST, MOST, "metres")
