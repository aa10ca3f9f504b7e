"""Calibrations that public tools write: which cameras a file holds."""

from pathlib import Path

from mua.capture.readers.calibrations.anipose import read_anipose
from mua.capture.readers.calibrations.calibrated import Calibrated
from mua.capture.readers.calibrations.colmap import is_colmap, read_colmap
from mua.capture.readers.calibrations.easymocap import EXTRINSICS, INTRINSICS, read_easymocap
from mua.errors import InputError


def read_cameras(path: Path) -> tuple[Calibrated, ...]:
    """The cameras of a .toml, of a folder with EasyMocap's two files, or of a COLMAP model.

    Errors: InputError that names file, camera and value.
    """
    if path.suffix.lower() == ".toml":
        return read_anipose(path)
    folder = path if path.is_dir() else path.parent
    if (folder / EXTRINSICS).is_file() and path.name not in ("cameras.txt", "cameras.bin"):
        return read_easymocap(folder)
    if is_colmap(folder):
        return read_colmap(folder)
    raise InputError(
        f"{path}: is no calibration that is read; expected a .toml of Pose2Sim, Caliscope or anipose, a folder with "
        f"{INTRINSICS} and {EXTRINSICS} of EasyMocap, or one with cameras and images (.txt or .bin) of COLMAP"
    )
