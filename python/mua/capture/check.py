"""Checks of a capture, before hours of training are spent on it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mua.arguments import amount
from mua.capture.camera import CaptureCamera
from mua.capture.capture import Capture
from mua.capture.diagnose import misplaced_tracks, remarks, unlikely
from mua.capture.fit import Posed, Seen, chosen_frames, look_at, mean_overlap
from mua.capture.inventory import missing_files
from mua.capture.unseen import unseen_surface
from mua.errors import InputError


@dataclass(frozen=True, eq=False)
class CameraFit:
    """The result for one camera."""

    camera: CaptureCamera
    views: tuple[Seen, ...]
    distance: float | None  # metres to the template; None where no pose could be read

    @property
    def mean(self) -> float | None:
        """Mean overlap of outline and mask, of views with the person."""
        return mean_overlap(self._filled) if self._filled else None

    @property
    def least(self) -> Seen | None:
        """The view that fits worst."""
        return min(self._filled, key=lambda view: view.overlap, default=None)

    @property
    def _filled(self) -> list[Seen]:
        """Views that show the person; no others count."""
        return [view for view in self.views if view.mask.any()]


@dataclass(frozen=True, eq=False)
class Checked:
    """The result of a check."""

    capture: Capture
    cameras: tuple[CameraFit, ...]
    problems: tuple[str, ...]  # what cannot be right, a sentence each
    remarks: tuple[str, ...]  # what may be right but is worth a look, a sentence each
    notes: tuple[str, ...]  # what the reader of the template decided
    posed: Posed

    @property
    def views(self) -> list[Seen]:
        """All views that were looked at."""
        return [view for camera in self.cameras for view in camera.views]


def check_capture(capture: Capture, *, frames: int | None = None) -> Checked:
    """Compare the posed template with the masks of some frames in all cameras.

    `frames` of each clip are looked at, all for 0; None looks at a few. Errors: InputError where the template cannot be
    read; all else is reported as a problem.
    """
    problems = list(missing_files(capture))
    posed = _posed(capture, problems)
    views = _views(capture, posed, frames, problems)
    problems += unlikely(capture, posed, views)
    problems += misplaced_tracks(capture, posed)
    noted = remarks(capture, views, fits=not problems) + ([] if problems else unseen_surface(capture, posed, views))
    person = [vertices.mean(axis=(0, 1)) for vertices in posed.vertices.values()]
    cameras = tuple(
        CameraFit(
            camera,
            tuple(view for view in views if view.camera.name == camera.name),
            float(np.linalg.norm(camera.position - np.mean(person, axis=0))) if person else None,
        )
        for camera in capture.cameras
    )
    return Checked(capture, cameras, tuple(problems), tuple(noted), capture.surfaces.notes, posed)


def _posed(capture: Capture, problems: list[str]) -> Posed:
    """The template in the poses of each clip whose motion can be read."""
    read = []
    for clip in capture.clips:
        try:
            capture.motion(clip.name)
        except InputError as error:
            problems.append(f"Clip {clip.name}: {error}.")
        else:
            read.append(clip)
    return Posed.of(capture, read)


def _views(capture: Capture, posed: Posed, frames: int | None, problems: list[str]) -> list[Seen]:
    """Views of the clips that were posed; an error is reported once for each camera and clip."""
    seen, reported = [], set()
    for clip in capture.clips:
        for frame in chosen_frames(capture, clip, frames) if clip.name in posed.vertices else ():
            for camera in capture.cameras:
                try:
                    seen.append(look_at(capture, posed, clip.name, frame, camera))
                except InputError as error:
                    if (clip.name, camera.name) not in reported and not str(error).endswith("there is no such file"):
                        reported.add((clip.name, camera.name))
                        problems.append(f"Camera {camera.name}, clip {clip.name}, frame {frame}: {error}.")
    return seen


def summary(capture: Capture) -> Sequence[str]:
    """The content of a capture as it is understood, line by line."""
    held_out = [camera.name for camera in capture.cameras if camera.held_out]
    clips = [
        f"{clip.name} ({amount(clip.frames, 'frame')}, poses {clip.first} to {clip.first + clip.frames - 1}"
        f"{', held out' if clip.held_out else ''})"
        for clip in capture.clips
    ]
    template, joints = capture.surfaces, amount(len(capture.surfaces.skeleton.names), "joint")
    height = np.ptp(template.vertices[:, 1])
    return (
        f"{capture.name}: {amount(len(capture.cameras), 'camera')}, {capture.rate:g} frames per second",
        f"held out: {', '.join(held_out) or 'no camera'}",
        f"clips: {', '.join(clips)}",
        f"template: {capture.template.name}, {height:.2f} m tall, {len(template.vertices):,} vertices, {joints}",
    )
