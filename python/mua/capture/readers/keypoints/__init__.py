"""3D keypoints of a person as markerless capture writes them."""

from dataclasses import replace
from pathlib import Path

from mua.arrays import Array
from mua.capture.readers.keypoints.freemocap import read_freemocap
from mua.capture.readers.keypoints.keypoints import Keypoints
from mua.capture.readers.keypoints.openpose import read_openpose
from mua.capture.readers.keypoints.trc import read_trc
from mua.errors import InputError


def read_keypoints(
    path: Path,
    *,
    axes: Array | None = None,  # [3, 3] from our world to the keypoints'
    scale: float = 1.0,
    rate: float | None = None,
) -> Keypoints:
    """The keypoints of a file or folder, in a world with Y up.

    `scale` multiplies what the reader takes for metres, and `rate` replaces the file's. Errors: InputError that names
    file and value.
    """
    keypoints = _read(path)
    turned = scale * (keypoints.points if axes is None else keypoints.points @ axes)
    return replace(keypoints, points=turned, rate=rate or keypoints.rate)


def _read(path: Path) -> Keypoints:
    if path.is_dir():
        return read_openpose(path)
    readers = {".trc": read_trc, ".csv": read_freemocap, ".npy": read_freemocap}
    if (reader := readers.get(path.suffix.lower())) is None:
        raise InputError(
            f"{path}: are no keypoints that are read; expected a .trc, a .csv or .npy of FreeMoCap, or a folder of "
            "EasyMocap's or OpenPose's .json files"
        )
    return reader(path)


__all__ = ["Keypoints", "read_keypoints"]
