"""A capture as training data: its subject, the windows of its frames, and its images as tensors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mua.capture import Capture, CaptureCamera
from mua.capture.store import ViewStore
from mua.capture.trust import MaskTrust
from mua.errors import InputError
from mua.pose.clip import Clip
from mua.pose.descriptor import choose_joints, choose_translated
from mua.pose.encoding import RATE, PoseEncoding
from mua.pose.windows import window_of
from mua.rig.bones import figure_scale
from mua.rig.skinning import moving_joints
from mua.splatting.projection import Eye
from mua.teachers.simulated.still import StillTeacher
from mua.teachers.trained.image_losses import Material, Perceptual
from mua.teachers.trained.model import Subject
from mua.teachers.trained.pose_refinement import PoseRefinement
from mua.teachers.trained.preview import Preview
from mua.teachers.trained.settings import TeacherSettings
from mua.teachers.trained.silhouette import Outline
from mua.teachers.trained.template_training import Observed
from mua.teachers.trained.views import Seen, Views
from mua.teachers.trained.windows import Window, windows

OUTLINES = 2  # masks of a frame that the template is compared with in one step


@dataclass(frozen=True, eq=False)
class Filmed:
    """A capture as training data; held-out clips and cameras are only previewed."""

    capture: Capture
    views: ViewStore
    trust: MaskTrust
    subject: Subject
    roles: Mapping[str, str]  # joint to body part, where the template's file says it
    clips: tuple[Clip, ...]  # of the training
    held: tuple[Clip, ...]
    device: torch.device

    @property
    def cameras(self) -> list[CaptureCamera]:
        """Cameras that the training samples from."""
        return [camera for camera in self.capture.cameras if not camera.held_out]

    def windows(self, clip: Clip) -> list[Window]:
        """The window of every frame; where frames are far apart, the motion says what was between them."""
        moving, steps = self.capture.moving(clip.name), self.capture.steps
        return windows(self.subject.rig.skeleton, self.subject.encoding, moving, every=steps)

    def see(self, clip: str, frame: int, camera: CaptureCamera) -> Seen:
        """A view, cut to the person; raises InputError that names camera, clip and frame where it cannot be read."""
        try:
            view = self.views.view(clip, frame, camera.name)
        except InputError as error:
            raise InputError(f"camera {camera.name}, clip {clip}, frame {frame}: {error}") from error
        image, mask = self._tensor(view.image), self._tensor(view.mask)
        background = None if view.background is None else self._tensor(view.background)
        return Seen(image, mask, Eye.of(view.camera, image), background, self.trust.weight(clip, frame, view))

    def _tensor(self, values: np.ndarray) -> Tensor:
        return torch.from_numpy(np.ascontiguousarray(values)).float().to(self.device)


def read_filmed(
    capture: Capture,
    settings: TeacherSettings,
    device: torch.device,
    *,
    views: Path,  # folder in which views are kept as they are trained on
) -> Filmed:
    """Read template and motion; raises InputError where either cannot be used or nothing is left to train on."""
    if all(clip.held_out for clip in capture.clips) or all(camera.held_out for camera in capture.cameras):
        raise InputError(f"{capture.file}: every clip or every camera is held out, so nothing is left to train on")
    character = capture.character()
    still = StillTeacher(character, texels=settings.texels)
    surfels = torch.from_numpy(still.frame(character.skeleton.bind_pose).texture.copy())
    clips, held = (
        tuple(capture.motion(clip.name) for clip in capture.clips if clip.held_out == out) for out in (False, True)
    )
    used = moving_joints(still.rig)
    encoding = PoseEncoding(
        choose_joints(character.skeleton, clips, used),
        rate=RATE,
        window=settings.window,
        translated=choose_translated(character.skeleton, clips, used),
    )
    store, subject = ViewStore(capture, views, rows=settings.rows), Subject(still.rig, surfels, encoding)
    return Filmed(capture, store, MaskTrust(capture), subject, character.roles, clips, held, device)


def material_of(filmed: Filmed, perceptual: Perceptual | None = None) -> Material:
    """The views of all training frames; frames of one clip follow each other."""
    frames = [(clip.name, frame) for clip in filmed.clips for frame in range(len(clip))]
    cameras = filmed.cameras
    views = Views(len(frames), len(cameras), lambda frame, camera: filmed.see(*frames[frame], cameras[camera]))
    return Material(views, [window for clip in filmed.clips for window in filmed.windows(clip)], perceptual)


@dataclass(frozen=True, eq=False)
class Outlines:
    """The masks of the training frames, as `Observations` of template_training."""

    material: Material

    @property
    def descriptors(self) -> Tensor:
        return torch.stack([window.descriptors[0] for window in self.material.windows])

    @property
    def joints(self) -> Tensor:
        return torch.stack([window.joints[0] for window in self.material.windows])

    def observe(self, frame: int, generator: torch.Generator) -> Observed:
        """The masks of some cameras."""
        views = self.material.views
        cameras = torch.randperm(views.cameras, generator=generator)[:OUTLINES]
        seen = [views.see(frame, camera) for camera in cameras.tolist()]
        return Observed(outlines=[Outline(one.eye, one.mask) for one in seen if one.weight > 0])


def refinement_of(filmed: Filmed, settings: TeacherSettings) -> PoseRefinement | None:
    """The refinement of all training frames; None where poses are taken as they are."""
    if not settings.refine:
        return None
    moving, steps = [filmed.capture.moving(clip.name) for clip in filmed.clips], filmed.capture.steps
    poses = [window_of(clip, frame, filmed.subject.encoding) for clip in moving for frame in range(0, len(clip), steps)]
    rotations, translations = (
        torch.from_numpy(np.stack([getattr(window, name) for window in poses]))
        for name in ("rotations", "translations")
    )
    rig = filmed.subject.rig
    size = figure_scale(rig.mesh.vertices)
    return PoseRefinement(rig.skeleton, rotations, translations, most=settings.refine, size=size)


def preview_of(filmed: Filmed, folder: Path) -> Preview:
    """The middle of a training clip and of one that is held out, by a camera that is held out; if there are such."""
    chosen: Sequence[Clip] = [*filmed.clips[:1], *filmed.held[:1]]
    found = [(clip, shown) for clip in chosen if (shown := _middle(filmed, clip)) is not None]
    return Preview(folder, [(seen, filmed.windows(clip)[frame]) for clip, (seen, frame) in found])


def _middle(filmed: Filmed, clip: Clip) -> tuple[Seen, int] | None:
    """The view with a person that is nearest to the middle of a clip, and its frame; held-out cameras come first."""
    cameras = sorted(filmed.capture.cameras, key=lambda camera: not camera.held_out)
    for camera in cameras:
        for frame in sorted(range(len(clip)), key=lambda frame: abs(frame - len(clip) // 2)):
            seen = filmed.see(clip.name, frame, camera)
            if seen.mask.any():
                return seen, frame
    return None
