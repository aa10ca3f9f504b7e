"""A tube that swings and grows wider as it does, what is seen of it, and a template that learns it."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import torch
from tube import HEIGHT, swing, tube

from mua import rotation
from mua.arrays import Array
from mua.camera import orbit
from mua.kernels.dq_skinning import blend_vertices
from mua.pose.descriptor import describe
from mua.pose.encoding import PoseEncoding
from mua.processes import ALONE, Processes
from mua.rig.build import build_rig
from mua.rig.rig import Rig
from mua.splatting.projection import Eye
from mua.student.optimise import Progress
from mua.student.settings import Schedule
from mua.teaching.mesh_losses import Cloud, Samples
from mua.teaching.motion_deformation import GraphSizes
from mua.teaching.silhouette import Outline
from mua.teaching.silhouette import outlines as drawn_outlines
from mua.teaching.template import DrivableTemplate
from mua.teaching.template_training import Observed, TemplateSettings, fit_template, template_of, training_run
from mua.teaching.track_losses import Tracks

ENCODING = PoseEncoding(joints=(1, 2), rate=30.0)
SETTINGS = TemplateSettings(
    sizes=GraphSizes(nodes=16, features=6),
    nodes=Schedule(steps=30, batch=2, lr=3e-2),
    offsets=Schedule(steps=30, batch=2, lr=3e-2),
    samples=1000,
)


@dataclass(frozen=True, eq=False)
class Swinging:
    """A tube that swings and grows wider by as much as its upper joint is turned."""

    descriptors: torch.Tensor
    joints: torch.Tensor
    truth: Array  # [F, V, 3] world
    see: Callable[[Array], Observed]
    drawn: int | None = None  # outlines of a frame that the generator chooses; None: all

    def observe(self, frame: int, generator: torch.Generator) -> Observed:
        seen = self.see(self.truth[frame])
        if self.drawn is None:
            return seen
        chosen = torch.randperm(len(seen.outlines), generator=generator)[: self.drawn]
        return replace(seen, outlines=[seen.outlines[i] for i in chosen])


@cache
def tube_rig() -> Rig:
    return build_rig(tube(), texels=16)[0]


def swinging(rig: Rig, see: Callable[[Array], Observed]) -> Swinging:
    clip = swing(tube())
    joints = rig.skeleton.skinning(clip.rotations, clip.translations)
    wider = 1 + 0.25 * clip.rotations[:, 2, 3:] / 0.4
    truth = []
    for own, factor in zip(joints, wider, strict=True):
        canonical = rig.mesh.vertices * np.array([factor[0], 1, factor[0]])
        truth.append(rotation.dual_transform(blend_vertices(own, rig.skin_indices, rig.skin_weights), canonical))
    described = describe(rig.skeleton, ENCODING, clip.rotations, clip.translations)
    return Swinging(torch.tensor(described).float(), torch.tensor(joints).float(), np.array(truth), see)


def surfaces(rig: Rig) -> Callable[[Array], Observed]:
    return lambda truth: Observed(cloud=Cloud.of(replace(rig.mesh, vertices=truth), 400))


def outlines(rig: Rig) -> Callable[[Array], Observed]:
    bounds = np.array([[-1.0, 0, -1], [1.0, HEIGHT, 1]])
    eyes = [
        Eye.of(orbit(bounds, screen=(56, 56), azimuth=azimuth), torch.zeros(1, dtype=torch.float32))
        for azimuth in (0.0, np.pi / 2)
    ]
    samples = Samples.of(rig.mesh, SETTINGS.samples)

    def see(truth: Array) -> Observed:
        posed = torch.tensor(truth).float()
        drawn = drawn_outlines(posed, samples, eyes)
        return Observed(outlines=[Outline(eye, mask) for eye, mask in zip(eyes, drawn, strict=True)])

    return see


def tracks(rig: Rig) -> Callable[[Array], Observed]:
    count = len(rig.mesh.vertices)
    corners = torch.arange(count)[:, None].expand(-1, 3)
    first = torch.tensor([[1.0, 0, 0]]).expand(count, 3)
    return lambda truth: Observed(tracks=Tracks(corners, first, torch.tensor(truth).float(), torch.ones(count)))


def silent(_: Progress) -> None:
    pass


def trained(
    seen: Swinging,
    rig: Rig,
    settings: TemplateSettings,
    directory: Path,
    report: Callable[[Progress], None] = silent,
    *,
    processes: Processes = ALONE,
) -> DrivableTemplate:
    run = training_run(seen, rig, ENCODING, settings, directory=directory, report=report, processes=processes)
    return fit_template(template_of(rig, ENCODING, settings), seen, rig, settings, run=run)
