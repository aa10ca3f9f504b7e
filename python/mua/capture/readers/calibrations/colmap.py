"""COLMAP's models: cameras and images as text or binary (https://colmap.github.io/format.html).

Its pixels count as ours do. Its scale and its axes are arbitrary where the model was not aligned to known points.
"""

import struct
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.capture.readers.calibrations.calibrated import Calibrated, coefficients, rigid
from mua.errors import InputError

MODELS = {  # by COLMAP's number: the name, where focal lengths and centre are, where OpenCV's coefficients are
    0: ("SIMPLE_PINHOLE", (0, 0, 1, 2), ()),
    1: ("PINHOLE", (0, 1, 2, 3), ()),
    2: ("SIMPLE_RADIAL", (0, 0, 1, 2), (3,)),
    3: ("RADIAL", (0, 0, 1, 2), (3, 4)),
    4: ("OPENCV", (0, 1, 2, 3), (4, 5, 6, 7)),
    6: ("FULL_OPENCV", (0, 1, 2, 3), (4, 5, 6, 7, 8, 9, 10, 11)),
}
NUMBERS = {name: number for number, (name, _, _) in MODELS.items()}
COUNTS = {number: max(*at, *lens) + 1 for number, (_, at, lens) in MODELS.items()}
POINT = struct.Struct("<ddq")  # of an image, which is not read
Lens = tuple[int, tuple[int, int], Array]  # model, size, parameters


def is_colmap(folder: Path) -> bool:
    """Whether a folder holds a model."""
    return any((folder / f"cameras{end}").is_file() and (folder / f"images{end}").is_file() for end in (".txt", ".bin"))


def read_colmap(folder: Path) -> tuple[Calibrated, ...]:
    """A camera for every image, called as the image without its suffix: `cam00`, or `cam00/000000`.

    Errors: InputError that names file, camera and value.
    """
    end = ".txt" if (folder / "cameras.txt").is_file() else ".bin"
    cameras, images = folder / f"cameras{end}", folder / f"images{end}"
    try:
        lenses = dict(_text_cameras(cameras) if end == ".txt" else _binary_cameras(cameras))
        seen = list(_text_images(images) if end == ".txt" else _binary_images(images))
    except (OSError, ValueError, IndexError, struct.error) as error:
        if isinstance(error, InputError):
            raise
        reason = error if end == ".txt" or isinstance(error, OSError) else "a file is cut short or damaged"
        raise InputError(f"{folder}: cameras{end} and images{end} cannot be read as COLMAP's: {reason}") from error
    if not seen:
        raise InputError(f"{images}: holds no image")
    return tuple(_camera(images, name, pose, number, lenses) for name, number, pose in seen)


def _camera(images: Path, file: str, pose: Array, number: int, lenses: dict[int, Lens]) -> Calibrated:
    where = f"{images}: {file}"
    if number not in lenses:
        raise InputError(f"{where}: its camera {number} is not in {images.with_stem('cameras').name}")
    model, size, parameters = lenses[number]
    _, at, lens = MODELS[model]
    fx, fy, column, row = (float(parameters[i]) for i in at)
    if not np.isfinite(parameters).all() or fx <= 0 or fy <= 0:
        raise InputError(
            f"{where}: camera {number} has the parameters {parameters.tolist()}; expected focal lengths above 0"
        )
    length = float(np.linalg.norm(pose[:4]))
    if not np.isfinite(pose).all() or length == 0:
        raise InputError(f"{where}: the pose is {pose.tolist()}; expected a quaternion and a translation")
    return Calibrated(
        name=str(PurePosixPath(file).with_suffix("")),
        where=where,
        size=size,
        focal=(fx, fy),
        centre=(column, row),
        distortion=coefficients([parameters[i] for i in lens], where),
        world_to_camera=rigid(rotation.to_matrix(pose[:4] / length), pose[4:], where),
    )


def _text_cameras(path: Path) -> Iterator[tuple[int, Lens]]:
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            name, model, width, height, *values = line.split()
            if model not in NUMBERS or len(values) != COUNTS[NUMBERS[model]]:
                raise _other_model(f"{path}, line {number}", f"{model} with {len(values)} parameters")
            yield int(name), (NUMBERS[model], (int(width), int(height)), np.array(values, float))


def _text_images(path: Path) -> Iterator[tuple[str, int, Array]]:
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    for line in lines[::2]:  # each second line has the image's points and may be empty
        if line.strip():
            _, *pose, number, name = line.split(maxsplit=9)
            yield name.strip(), int(number), np.array(pose, float)


def _binary_cameras(path: Path) -> Iterator[tuple[int, Lens]]:
    content, at = path.read_bytes(), 8
    for _ in range(*struct.unpack_from("<Q", content)):
        name, model, width, height = struct.unpack_from("<iiQQ", content, at)
        if model not in MODELS:
            raise _other_model(f"{path}: camera {name}", f"number {model}")
        values = np.array(struct.unpack_from(f"<{COUNTS[model]}d", content, at + 24))
        at += 24 + 8 * COUNTS[model]
        yield name, (model, (width, height), values)


def _binary_images(path: Path) -> Iterator[tuple[str, int, Array]]:
    content, at = path.read_bytes(), 8
    for _ in range(*struct.unpack_from("<Q", content)):
        _, *pose, number = struct.unpack_from("<i7di", content, at)
        end = content.index(b"\0", at + 64)
        (points,) = struct.unpack_from("<Q", content, end + 1)
        yield content[at + 64 : end].decode(), number, np.array(pose)
        at = end + 9 + POINT.size * points


def _other_model(where: str, found: str) -> InputError:
    names = ", ".join(NUMBERS)
    return InputError(f"{where}: the camera model is {found}; expected {names}, or undistort the images first")
