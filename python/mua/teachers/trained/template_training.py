"""The training of the drivable template: first the nodes' motion, then the vertices' offsets beside it, then a
regression for other motion.

The loss compares with what was observed of each frame: a surface, outlines, tracked points, or several of these. A
killed run resumes from its last checkpoint and ends in the same bytes.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

import torch
from torch import Tensor, nn

from mua.pose.encoding import PoseEncoding
from mua.rig.rig import Rig
from mua.teachers.trained.drivable_template import DrivableTemplate
from mua.teachers.trained.mesh_losses import Cloud, Samples, chamfer, edges_of, roughness
from mua.teachers.trained.motion_deformation import Deformed, GraphSizes, MotionDeformation
from mua.teachers.trained.parameters import deterministic, gradients_for
from mua.teachers.trained.silhouette import Outline, silhouette_error
from mua.teachers.trained.track_losses import Tracks, track_error
from mua.training.optimise import Run, optimise
from mua.training.schedule import Schedule

STAGES = ("template nodes", "template offsets")
SEEDS = 1 << 62
UNIT = 0.01  # metres on a person: an error of 1 in every term that is a length


@dataclass(frozen=True)
class TemplateWeights:
    """The weight of each term of the loss; lengths are in squares of UNIT."""

    surface: float = 1.0
    tracks: float = 1.0
    silhouette: float = 100.0  # squared difference in coverage, over what the mask covers
    rigid: float = 0.1  # distance of nodes from where neighbours would carry them
    smooth: float = 1.0  # difference of the offsets at both ends of an edge
    offset: float = 0.05  # length of the offsets


@dataclass(frozen=True)
class TemplateSettings:
    """Sizes and schedules of the template; the batch of a schedule is a number of frames."""

    sizes: GraphSizes = field(default_factory=GraphSizes)
    nodes: Schedule = field(default_factory=lambda: Schedule(steps=600, batch=4, lr=1e-2, warm_up=0.05))
    offsets: Schedule = field(default_factory=lambda: Schedule(steps=900, batch=4, lr=1e-2, warm_up=0.05))
    samples: int = 4000  # points of the template that are compared with a surface
    weights: TemplateWeights = field(default_factory=TemplateWeights)
    weight_decay: float = 1e-2
    seed: int = 0


@dataclass(frozen=True, eq=False)
class Observed:
    """Observations of one frame."""

    cloud: Cloud | None = None
    outlines: Sequence[Outline] = ()
    tracks: Tracks | None = None


class Observations(Protocol):
    """F frames of a person."""

    @property
    def descriptors(self) -> Tensor:
        """[F, D] of mua.pose.descriptor."""
        ...

    @property
    def joints(self) -> Tensor:
        """[F, J, 8] bind pose to world."""
        ...

    def observe(self, frame: int, generator: torch.Generator) -> Observed:
        """What was observed of a frame; choices, such as of cameras, are drawn from the generator."""
        ...


def template_of(rig: Rig, encoding: PoseEncoding, settings: TemplateSettings) -> DrivableTemplate:
    """A template that is not trained yet: skinning alone moves it."""
    return DrivableTemplate(rig, MotionDeformation(rig, encoding, settings.sizes))


def fit_template(
    template: DrivableTemplate, observations: Observations, rig: Rig, settings: TemplateSettings, *, run: Run
) -> DrivableTemplate:
    """Train a template of `template_of` in place, as one of the stages of a run; returns it."""
    deformation = template.deformation
    assert isinstance(deformation, MotionDeformation)
    deformation.prepare(observations.descriptors.cpu(), run.alone("template").generator)
    template.to(run.device)
    template_loss = _TemplateLoss(template, observations, rig, settings, size=run.size)
    schedules = (settings.nodes, settings.offsets)
    nodes = [*deformation.node_features.parameters(), *deformation.node_motion.parameters()]
    offsets = [*deformation.vertex_features.parameters(), *deformation.vertex_offsets.parameters()]
    with deterministic():
        for stage, schedule, parameters in zip(STAGES, schedules, (nodes, [*nodes, *offsets]), strict=True):
            own = run.alone(stage)
            with gradients_for(template, parameters):
                groups: list[dict[str, object]] = [{"params": parameters, "weight_decay": settings.weight_decay}]
                loss = partial(_mean_loss, frames=len(observations.descriptors), schedule=schedule, run=own)
                template_loss.offsets = stage == STAGES[-1]
                optimise(template_loss, loss, schedule=schedule, parameters=groups, stage=stage, run=own)
        deformation.carry_over(observations.descriptors, run=run)
    return template.requires_grad_(False).eval()


class _TemplateLoss(nn.Module):
    """The template's loss over frames."""

    def __init__(
        self,
        template: DrivableTemplate,
        observations: Observations,
        rig: Rig,
        settings: TemplateSettings,
        *,
        size: float,
    ) -> None:
        super().__init__()
        self.template = template
        self.offsets = False
        self._observations, self._weights = observations, settings.weights
        self._samples = Samples.of(rig.mesh, settings.samples)
        self._edges = edges_of(rig.mesh)
        self._unit, self._size = (UNIT * size) ** 2, size

    def forward(self, frames: Tensor, seeds: Tensor) -> Tensor:
        """The mean loss over frames [B]; a seed [B] for what each frame's observation draws."""
        deformation = self.template.deformation
        assert isinstance(deformation, MotionDeformation)
        device = deformation.mean.device
        descriptors, joints = (
            values[frames].to(device) for values in (self._observations.descriptors, self._observations.joints)
        )
        deformed = deformation.deform(descriptors, offsets=self.offsets)
        posed = self.template.pose(deformed.vertices, joints).posed
        seen = [
            self._observation_loss(own, self._observations.observe(frame, torch.Generator().manual_seed(seed)))
            for frame, seed, own in zip(frames.tolist(), seeds.tolist(), posed, strict=True)
        ]
        return torch.stack(seen).mean() + self._regularisation(deformation, deformed)

    def _observation_loss(self, posed: Tensor, observed: Observed) -> Tensor:
        """How far a posed template [V, 3] is from what was seen."""
        weights, loss = self._weights, posed.new_zeros(())
        if observed.cloud is not None:
            loss = loss + weights.surface / self._unit * chamfer(posed, self._samples, observed.cloud)
        if observed.tracks is not None:
            loss = loss + weights.tracks / self._unit * track_error(posed, observed.tracks, size=self._size)
        if observed.outlines:
            loss = loss + weights.silhouette * silhouette_error(posed, self._samples, observed.outlines)
        return loss

    def _regularisation(self, deformation: MotionDeformation, deformed: Deformed) -> Tensor:
        """Regularisation: neighbours move alike."""
        weights = self._weights
        rigid = deformation.graph.rigidity_error(deformed.turns, deformed.moves)
        smooth = roughness(deformed.offsets, self._edges)
        offset = deformed.offsets.square().sum(-1).mean()
        return (weights.rigid * rigid + weights.smooth * smooth + weights.offset * offset) / self._unit


def _mean_loss(model: Callable[..., Tensor], *, frames: int, schedule: Schedule, run: Run) -> Tensor:
    """This process's part of the mean loss over a batch that all processes draw alike."""
    drawn = torch.randint(frames, (schedule.batch,), generator=run.generator)
    seeds = torch.randint(SEEDS, (schedule.batch,), generator=run.generator)
    own = slice(run.processes.rank, None, run.processes.count)
    count = len(drawn[own])
    if not count:  # fewer frames than processes: a loss of zero
        return 0 * model(drawn[:1], seeds[:1])
    return model(drawn[own], seeds[own]) * (count * run.processes.count / len(drawn))
