"""The template learns from surfaces, outlines and tracks, and a killed training ends in the same bytes."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
import torch
from tube import HEIGHT, RADIUS, swing, tube

from mua import rotation
from mua.arrays import Array
from mua.camera import orbit
from mua.kernels.dq_skinning import blend_vertices
from mua.pose.descriptor import describe
from mua.pose.encoding import PoseEncoding
from mua.rig.build import build_rig
from mua.rig.rig import Rig
from mua.splatting.projection import Eye
from mua.student import optimise
from mua.student.optimise import Progress
from mua.student.settings import Schedule
from mua.teaching.mesh_losses import Cloud, Samples, chamfer
from mua.teaching.motion_deformation import GraphSizes
from mua.teaching.silhouette import Outline
from mua.teaching.silhouette import outlines as drawn_outlines
from mua.teaching.template import DrivableTemplate
from mua.teaching.template_training import (
    STAGES,
    Observed,
    TemplateSettings,
    fit_template,
    template_of,
    training_run,
)
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

    def observe(self, frame: int, generator: torch.Generator) -> Observed:
        return self.see(self.truth[frame])


@pytest.fixture(scope="module")
def rig() -> Rig:
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
) -> DrivableTemplate:
    run = training_run(seen, rig, ENCODING, settings, directory=directory, report=report)
    return fit_template(template_of(rig, ENCODING, settings), seen, rig, settings, run=run)


def error(template: DrivableTemplate, seen: Swinging, rig: Rig) -> float:
    """The distance between the template and the true surface, metres."""
    samples = Samples.of(rig.mesh, 500)
    with torch.no_grad():
        posed = template(seen.descriptors[::4], seen.joints[::4]).posed.double()
        clouds = [Cloud.of(replace(rig.mesh, vertices=truth), 1000) for truth in seen.truth[::4]]
        away = [chamfer(own, samples, cloud, sideways=0.0) for own, cloud in zip(posed, clouds, strict=True)]
    return float(torch.stack(away).sqrt().mean())


@pytest.mark.parametrize(
    ("see", "left"), [(surfaces, 0.4), (outlines, 0.7), (tracks, 0.4)], ids=["surfaces", "outlines", "tracks"]
)
def test_the_template_learns_how_motion_deforms_it(
    rig: Rig, see: Callable[[Rig], Callable[[Array], Observed]], left: float, tmp_path: Path
) -> None:
    seen = swinging(rig, see(rig))
    skinned = error(DrivableTemplate(rig), seen, rig)
    assert skinned > 0.1 * RADIUS
    learnt = trained(seen, rig, SETTINGS, tmp_path)
    assert error(learnt, seen, rig) < left * skinned
    assert not any(parameter.requires_grad for parameter in learnt.parameters())


def test_a_killed_training_ends_in_the_same_bytes(rig: Rig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(optimise, "CHECKPOINT_STEPS", 4)
    seen = swinging(rig, surfaces(rig))
    short = replace(SETTINGS, nodes=Schedule(10, 2, 1e-2), offsets=Schedule(10, 2, 1e-2))

    def train(directory: Path, dies_at: tuple[str, int] | None = None) -> DrivableTemplate:
        def report(progress: Progress) -> None:
            if (progress.stage, progress.step) == dies_at:
                raise KeyboardInterrupt

        return trained(seen, rig, short, directory, report)

    whole = train(tmp_path / "whole").state_dict()
    for stage in STAGES:
        with pytest.raises(KeyboardInterrupt):
            train(tmp_path / stage, (stage, 6))
        resumed = train(tmp_path / stage).state_dict()
        assert all(torch.equal(whole[name], resumed[name]) for name in whole)


def test_what_was_trained_is_taken_up_without_looking_again(rig: Rig, tmp_path: Path) -> None:
    seen = swinging(rig, surfaces(rig))
    short = replace(SETTINGS, nodes=Schedule(3, 2, 1e-2), offsets=Schedule(3, 2, 1e-2))
    first = trained(seen, rig, short, tmp_path).state_dict()

    def never(_: Array) -> Observed:
        raise AssertionError("looked at a frame")

    again = trained(replace(seen, see=never), rig, short, tmp_path)
    assert all(torch.equal(first[name], value) for name, value in again.state_dict().items())
    other = replace(short, seed=1)
    with pytest.raises(AssertionError, match="looked at a frame"):
        trained(replace(seen, see=never), rig, other, tmp_path)


def test_first_the_nodes_alone_are_trained(rig: Rig, tmp_path: Path) -> None:
    seen = swinging(rig, surfaces(rig))
    run = training_run(seen, rig, ENCODING, SETTINGS, directory=tmp_path, report=stop_after_nodes)
    template = template_of(rig, ENCODING, SETTINGS)
    with pytest.raises(KeyboardInterrupt):
        fit_template(template, seen, rig, SETTINGS, run=run)
    state = template.state_dict()
    assert state["deformation.node_motion.weight"].abs().max() > 0
    assert state["deformation.vertex_offsets.weight"].abs().max() == 0


def stop_after_nodes(progress: Progress) -> None:
    if progress.stage == STAGES[0] and progress.step == progress.steps:
        raise KeyboardInterrupt
