"""Points that were followed through the frames of a clip: in the world, or in the images of one camera."""

import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.capture.camera import CaptureCamera
from mua.capture.capture import Capture
from mua.capture.lens import undistorted
from mua.errors import InputError

ARRAYS = ("points", "seen", "bind")  # of a file of tracks


@dataclass(frozen=True, eq=False)
class PointTracks:
    """P points in the F frames of a clip, each on a ray from a camera or, without `directions`, at a place."""

    file: Path
    points: Array  # [F, P, 3] world, metres: places, or where the rays begin; 0 where nothing was seen
    weights: Array  # [F, P] how sure it is that a point was seen, 0..1
    directions: Array | None = None  # [F, P, 3] unit
    bind: Array | None = None  # [P, 3] where they lie on the template in its bind pose, metres


def read_tracks(capture: Capture, clip: str) -> list[PointTracks]:
    """All tracks of a clip that training may see: those in the world, then those of cameras that are not held out.

    Errors: InputError with one sentence that names the file, and array, frame and point where one of them is wrong.
    """
    found = []
    if capture.tracks is not None:
        found.append(_read(capture.place(capture.tracks, clip=clip), capture, clip, None))
    if capture.tracks_2d is not None:
        cameras = [camera for camera in capture.cameras if not camera.held_out]
        files = [capture.place(capture.tracks_2d, clip=clip, camera=camera.name) for camera in cameras]
        found += [_read(file, capture, clip, camera) for file, camera in zip(files, cameras, strict=True)]
    return found


def _read(file: Path, capture: Capture, clip: str, camera: CaptureCamera | None) -> PointTracks:
    held = _arrays(file)
    points, frames, axes = held["points"], capture.clip(clip).frames, 3 if camera is None else 2
    if points.ndim != 3 or points.shape[0] != frames or points.shape[2] != axes:
        expected = f"[{frames}, points, {axes}]: clip {clip!r} has {frames} frames"
        raise InputError(f"{file}: points has shape {list(points.shape)}; expected {expected}")
    weights = _weights(file, points, held.get("seen"))
    points = np.where(weights[..., None] > 0, points, 0)
    bind = _bind(file, points.shape[1], held.get("bind"))
    if camera is None:
        return PointTracks(file, points, weights, bind=bind)
    origins = np.broadcast_to(camera.position, (*points.shape[:2], 3))
    return PointTracks(file, origins, weights, directions=_rays(camera, points), bind=bind)


def _arrays(file: Path) -> dict[str, Array]:
    """The arrays of a file by name, as float64."""
    if not file.is_file():
        raise InputError(f"{file}: there is no such file; capture.json names tracks for every clip")
    try:
        with np.load(file, allow_pickle=False) as opened:
            held = {name: np.asarray(opened[name], np.float64) for name in opened.files}
    except (OSError, ValueError, TypeError, AttributeError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(f"{file}: cannot be read as an .npz file of numbers: {error}") from error
    unknown = next((name for name in held if name not in ARRAYS), None)
    if unknown is not None:
        raise InputError(f"{file}: {unknown!r} is no array of tracks; there are {', '.join(ARRAYS)}")
    if "points" not in held:
        raise InputError(f"{file}: holds no points")
    return held


def _weights(file: Path, points: Array, seen: Array | None) -> Array:
    """[F, P] from what the file says, or where it says nothing, from which points are finite."""
    finite = np.isfinite(points).all(axis=2)
    weights = np.asarray(finite if seen is None else seen, np.float64)
    if weights.shape != finite.shape:
        raise InputError(f"{file}: seen has shape {list(weights.shape)}; expected {list(finite.shape)} as points")
    if not ((weights >= 0) & (weights <= 1)).all():
        raise InputError(f"{file}: seen has values from {weights.min():g} to {weights.max():g}; expected 0 to 1")
    for frame, point in np.argwhere((weights > 0) & ~finite)[:1]:
        raise InputError(f"{file}: frame {frame}: point {point} is seen, but its place is not finite")
    if not weights.any():
        raise InputError(f"{file}: no point is seen in any frame")
    return weights


def _bind(file: Path, count: int, bind: Array | None) -> Array | None:
    if bind is not None and (bind.shape != (count, 3) or not np.isfinite(bind).all()):
        raise InputError(f"{file}: bind has shape {list(bind.shape)}; expected finite places [{count}, 3]")
    return bind


def _rays(
    camera: CaptureCamera,
    pixels: Array,  # [..., 2] of its images as they were filmed
) -> Array:
    """Unit directions [..., 3] in the world."""
    x, y = np.moveaxis((pixels - camera.centre) / camera.focal, -1, 0)
    x, y = undistorted(x, y, camera.distortion)
    ahead = np.stack([x, y, np.ones_like(x)], axis=-1)
    ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
    return np.asarray(ahead @ camera.world_to_camera[:3, :3])
