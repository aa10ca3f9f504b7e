"""Writing capture.json."""

import json
import os
from pathlib import Path
from typing import Any

from mua.capture.camera import UNDISTORTED, CaptureCamera
from mua.capture.capture import FORMAT, VERSION, Capture, CaptureClip
from mua.files.write import write_bytes


def write_capture(capture: Capture) -> Path:
    """Write the capture.json of `capture.folder`, all of it or none; returns its path.

    Files below the folder are named from it, so that the folder can be moved. `open_capture` checks what was written.
    """
    text = json.dumps(_described(capture), indent=1, allow_nan=False) + "\n"
    write_bytes(capture.file, text.encode())
    return capture.file


def _described(capture: Capture) -> dict[str, Any]:
    described: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "name": capture.name,
        "rate": float(capture.rate),
        "template": _from(capture.folder, capture.template),
    }
    if capture.template_height is not None:
        described["template_height"] = float(capture.template_height)
    if capture.leave_out:
        described["leave_out"] = list(capture.leave_out)
    described["clips"] = [_clip(clip, capture.folder) for clip in capture.clips]
    for field in ("images", "masks", "backgrounds", "meshes", "tracks", "tracks_2d"):
        if getattr(capture, field) is not None:
            described[field] = getattr(capture, field)
    if capture.trim_masks:
        described["trim_masks"] = int(capture.trim_masks)
    return described | {"cameras": [_camera(camera) for camera in capture.cameras]}


def _clip(clip: CaptureClip, folder: Path) -> dict[str, Any]:
    described = {
        "name": clip.name,
        "motion": _from(folder, clip.motion),
        "first": int(clip.first),
        "frames": int(clip.frames),
        "held_out": bool(clip.held_out),
    }
    return described | ({"first_image": int(clip.first_image)} if clip.first_image else {})


def _camera(camera: CaptureCamera) -> dict[str, Any]:
    described: dict[str, Any] = {
        "name": camera.name,
        "size": [int(side) for side in camera.size],
        "focal": [float(focal) for focal in camera.focal],
        "centre": [float(centre) for centre in camera.centre],
        "world_to_camera": camera.world_to_camera.tolist(),
        "held_out": bool(camera.held_out),
    }
    if tuple(camera.distortion) != UNDISTORTED:
        described["distortion"] = [float(coefficient) for coefficient in camera.distortion]
    return described


def _from(folder: Path, path: Path) -> str:
    """A path as capture.json names it: from the folder where it lies below it, else from the root."""
    absolute, base = Path(os.path.abspath(path)), Path(os.path.abspath(folder))  # noqa: PTH100, links stay links
    return absolute.relative_to(base).as_posix() if absolute.is_relative_to(base) else str(absolute)
