"""The stages of a teacher's training; each leaves its result in the teacher's folder and goes on from there."""

from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import torch

from mua.asset.storable import require_names
from mua.baking.listener import Listener
from mua.capture import open_capture
from mua.capture.inventory import missing_files
from mua.teachers.trained.folder import Description, save_teacher
from mua.teachers.trained.frame_surfaces import measured_surfaces
from mua.teachers.trained.from_capture import Filmed, Outlines, material_of, preview_of, read_filmed, refinement_of
from mua.teachers.trained.image_losses import ImageLoss, Material, Perceptual
from mua.teachers.trained.model import TeacherModel
from mua.teachers.trained.motion_deformation import REGRESSION
from mua.teachers.trained.preview import Preview
from mua.teachers.trained.settings import TeacherSettings
from mua.teachers.trained.splat_training import STAGES, TEXTURE, train_teacher
from mua.teachers.trained.template_training import STAGES as TEMPLATE_STAGES
from mua.teachers.trained.template_training import Observations, TemplateSettings, fit_template
from mua.teachers.trained.tracked_points import Tracked, tracks_of
from mua.training.checkpoint import Checkpoints, run_key
from mua.training.optimise import Progress, Run
from mua.training.processes import Processes

TEMPLATE = TemplateSettings()


def carry_out(
    folder: Path,
    output: Path,
    settings: TeacherSettings,
    device: torch.device,
    listener: Listener,
    processes: Processes,
    *,
    weights: Path | None,  # of LPIPS
) -> None:
    """Train the teacher of a capture and write it to `output`; the first of several processes writes and reports."""
    listener.stage("capture")
    capture = open_capture(folder)
    clips = [clip.name for clip in capture.clips]
    require_names(str(capture.file), [capture.name], capture.surfaces.skeleton.names, clips)
    if settings.drivable is None:
        settings = replace(settings, drivable=capture.meshes is not None)
    for sentence in missing_files(capture):
        listener.note(f"{sentence} Views without image or mask count nowhere.")
    filmed = read_filmed(capture, settings, device, views=output / "work" / "views")
    if weights is None:
        listener.note("without --lpips-weights no perceptual term is trained on")
    material = replace(material_of(filmed, _perceptual(weights, device)), tracks=tracks_of(filmed))
    torch.manual_seed(settings.seed)
    teacher = TeacherModel(filmed.subject, settings)
    image_loss = ImageLoss(teacher, material, settings, refinement=refinement_of(filmed, settings)).to(device)
    checkpoints = Checkpoints(output / "work", _key(filmed, settings, weights, material), processes)
    if processes.first:
        checkpoints.remove_leftovers((*TEMPLATE_STAGES, REGRESSION, *STAGES))
    preview = preview_of(filmed, output / "progress") if processes.first else None
    report = _Reporter(image_loss, preview, listener)
    run = Run(torch.Generator().manual_seed(settings.seed), checkpoints, report, device, processes)
    if settings.drivable:
        own = replace(TEMPLATE, seed=settings.seed)
        seen: Observations = measured_surfaces(filmed) or Outlines(material)
        seen = Tracked(seen, material.tracks) if material.tracks else seen
        fit_template(teacher.template, seen, filmed.subject.rig, own, run=run)
    train_teacher(image_loss, material, settings, run=run)
    if processes.first:
        save_teacher(output, teacher, Description(capture.name, settings, filmed.subject.encoding, filmed.roles))


def _key(filmed: Filmed, settings: TeacherSettings, weights: Path | None, material: Material) -> str:
    """Changes with everything that a training depends on but the images themselves."""
    rig = filmed.subject.rig
    skin = (rig.mesh.vertices, rig.mesh.faces, rig.skin_indices, rig.skin_weights, rig.skeleton.bind_inverse)
    poses = [values for clip in filmed.clips for values in (clip.rotations, clip.translations)]
    points = [values for of in material.tracks for values in (*vars(of.tracks).values(), of.texels)]
    description = filmed.capture.file.read_bytes()
    return run_key(
        (settings, description, None if weights is None else sha256(weights.read_bytes()).hexdigest()),
        [filmed.subject.surfels, *map(torch.as_tensor, (*skin, *poses)), *(one for one in points if one is not None)],
    )


def _perceptual(weights: Path | None, device: torch.device) -> Perceptual | None:
    if weights is None:
        return None
    from mua.splatting.perceptual import Lpips  # with torchmetrics, which takes seconds to load

    return Lpips(weights).to(device).distance


class _Reporter:
    """Reports stages and steps, and compares images of a held-out camera now and then."""

    def __init__(self, image_loss: ImageLoss, preview: Preview | None, listener: Listener) -> None:
        self._image_loss, self._preview, self._listener = image_loss, preview, listener
        self._stage, self._score = "", ""

    def __call__(self, progress: Progress) -> None:
        if self._preview is None:
            return
        if progress.stage != self._stage:
            self._stage, self._score = progress.stage, ""
            self._listener.stage(progress.stage)
        if self._preview.seen and self._preview.due(progress.step, progress.steps):
            name = f"{progress.stage.replace(' ', '_')}_{progress.step:07d}"
            self._score = f", {self._preview(self._image_loss, name, moving=progress.stage == TEXTURE):.1f} dB"
        loss = f"loss {progress.loss:.4f}{self._score}"
        self._listener.step(progress.step, progress.steps, detail=f"{loss}, {progress.rate:.1f} steps/s")
