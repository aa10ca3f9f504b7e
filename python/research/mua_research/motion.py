"""From a recording to what the systems learn from: descriptors, the shared coarse mesh of every frame, targets."""

from collections.abc import Callable

import numpy as np
import torch
from torch import Tensor

from mua import rotation
from mua.arrays import Array
from mua.channels import APPEARANCE, CHANNELS, GEOMETRY
from mua.kernels.dq_skinning import blend_vertices
from mua.pose.clip import Clip
from mua.pose.descriptor import describe, heading_of
from mua.recording import Recording
from mua.rig.bones import figure_scale
from mua.rig.rig import Rig
from mua.student.coarse import fit_coarse, set_pca
from mua.student.distil import prepare
from mua.student.model import Student
from mua.student.settings import Settings
from mua.student.subband_source import hold
from mua.student.targets import channel_weights
from mua.training.optimise import Run
from mua.wavelets import Bands
from mua_research.system import Motion, Sizes, TrainingFrames


def training_frames(recording: Recording, settings: Settings, *, run: Run) -> TrainingFrames:
    """Train the mesh that all systems share, and gather what they learn from.

    Raises InputError where the recording has another texture size than `settings`, or no training frame.
    """
    student, samples = prepare(recording, settings)
    student.to(run.device)
    inputs = student.normalize(samples.descriptors.to(run.device))
    pca = set_pca(student.coarse, samples.meshes(torch.arange(len(samples))).to(run.device), run)
    components = student.components
    fit_coarse(student.coarse, inputs, pca, components=components, settings=settings, run=run, parts=samples.parts)
    student.requires_grad_(False).cpu()
    frames = len(samples)
    bands = hold(samples.subbands, slice(0, CHANNELS), frames=frames, size=settings.texels)
    mean, variance = band_statistics(bands, frames=frames, texels=settings.texels)
    parts = [
        motion_of(clip, clip.recorded, rig=recording.rig, student=student)
        for clip in recording.clips
        if not clip.held_out and len(clip.recorded)
    ]
    size = figure_scale(recording.rig.mesh.vertices)
    return TrainingFrames(
        rig=recording.rig,
        sizes=Sizes(
            settings,
            student.encoding,
            len(components),
            len(student.coarse.mean),
            student.texels,
            recording.wavelet,
        ),
        student=student,
        motion=Motion(
            torch.cat([part.descriptors for part in parts]),
            torch.cat([part.inputs for part in parts]),
            torch.cat([part.canonical for part in parts]),
            torch.cat([part.posed for part in parts]),
        ),
        bands=bands,
        mean=mean,
        mean_texture=samples.mean_texture,
        weights=torch.cat([channel_weights(variance[part], part, size=size) for part in (GEOMETRY, APPEARANCE)]),
        parts=samples.parts,
        device=run.device,
    )


def motion_of(
    clip: Clip,  # at the rate of the student's encoding
    frames: Array,  # [F] which of its frames
    *,
    rig: Rig,
    student: Student,
) -> Motion:
    """What the systems see of some frames of a clip, whether they were trained on them or not."""
    described = describe(rig.skeleton, student.encoding, clip.rotations, clip.translations)[frames]
    descriptors = torch.from_numpy(described).float()
    with torch.no_grad():
        canonical = student.mesh(descriptors)
    posed = np.zeros(canonical.shape, np.float32)
    for row, frame in enumerate(frames):
        posed[row] = pose_about_root(
            rig, canonical[row].numpy(), clip, int(frame), remove_heading=student.encoding.remove_heading
        )
    return Motion(student.normalize(descriptors), student.read(descriptors), canonical, torch.from_numpy(posed))


def pose_about_root(
    rig: Rig,
    canonical: Array,  # [V, 3] metres
    clip: Clip,
    frame: int,
    *,
    remove_heading: bool,
) -> Array:
    """Posed vertices [V, 3] relative to the root joint, its heading removed with `remove_heading`, metres."""
    rotations, translations = clip.rotations[frame], clip.translations[frame]
    joints = rig.skeleton.skinning(rotations, translations)
    posed = rotation.dual_transform(blend_vertices(joints, rig.skin_indices, rig.skin_weights), canonical)
    _, places = rig.skeleton.world(rotations, translations)
    relative = posed - places[rig.skeleton.root]
    if remove_heading:
        relative = rotation.rotate(rotation.conjugate(heading_of(joints[rig.skeleton.root, :4])), relative)
    return np.asarray(relative)


def band_statistics(bands: Callable[[slice, Tensor], Bands], *, frames: int, texels: int) -> tuple[Bands, Tensor]:
    """The mean subbands [1, ...] of the training frames, and the texel variance [23] about them."""
    means, energy = [], []
    for channel in range(CHANNELS):
        own = bands(slice(channel, channel + 1), torch.arange(frames))
        means.append([band.mean(0, keepdim=True) for band in own])
        energy.append(sum(float((band - band.mean(0)).square().sum()) for band in own))
    ll, d3, d2 = zip(*means, strict=True)
    mean = Bands(torch.cat(ll, dim=1), torch.cat(d3, dim=2), torch.cat(d2, dim=2))
    return mean, torch.tensor(energy) / (frames * texels**2)
