"""Calibrations that public tools write: which cameras a file holds."""

from pathlib import Path

from mua.capture.readers.calibrations.actorshq import is_actorshq, read_actorshq
from mua.capture.readers.calibrations.anipose import read_anipose
from mua.capture.readers.calibrations.calibrated import Calibrated
from mua.capture.readers.calibrations.colmap import is_colmap, read_colmap
from mua.capture.readers.calibrations.easymocap import EXTRINSICS, INTRINSICS, read_easymocap
from mua.capture.readers.calibrations.refused import refuse_others
from mua.capture.readers.calibrations.transforms import is_transforms, read_transforms
from mua.errors import InputError


def read_cameras(path: Path) -> tuple[Calibrated, ...]:
    """The cameras of a .toml, of ActorsHQ's .csv, a transforms.json, EasyMocap's two files, or a COLMAP model.

    Errors: InputError that names file, camera and value.
    """
    if path.suffix.lower() == ".toml":
        return read_anipose(path)
    if is_actorshq(path):
        return read_actorshq(path)
    if is_transforms(path):
        return read_transforms(path)
    folder = path if path.is_dir() else path.parent
    if (folder / EXTRINSICS).is_file() and path.name not in ("cameras.txt", "cameras.bin"):
        return read_easymocap(folder)
    if is_colmap(folder):
        return read_colmap(folder)
    if path.is_dir() and (found := calibration_in(path)):
        return read_cameras(found)
    refuse_others(path)
    raise InputError(
        f"{path}: is no calibration that is read; expected a .toml of Pose2Sim, Caliscope or anipose, calibration.csv "
        f"of ActorsHQ, transforms.json of Nerfstudio, a folder with {INTRINSICS} and {EXTRINSICS} of EasyMocap, or one "
        "with cameras and images (.txt or .bin) of COLMAP"
    )


def calibration_in(folder: Path) -> Path | None:
    """The calibration that a folder of images holds, where programs leave it."""
    files = (file for pattern in ("*alib*.toml", "*.csv", "transforms*.json") for file in sorted(folder.glob(pattern)))
    for place in (folder, folder / "sparse" / "0", folder / "sparse", *files):
        if (place / EXTRINSICS).is_file() or is_colmap(place) or _is_read(place):
            return place
    return None


def _is_read(file: Path) -> bool:
    return file.suffix.lower() == ".toml" or is_actorshq(file) or is_transforms(file)
