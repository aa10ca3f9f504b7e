"""The template is trained on surfaces, outlines and tracks, and a killed training ends in the same bytes."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import torch
from swinging import ENCODING, SETTINGS, Swinging, outlines, surfaces, swinging, template_run, tracks, trained, tube_rig
from together import errors as errors_of
from together import start, template_losses
from tube import RADIUS

from mua.arrays import Array
from mua.rig.rig import Rig
from mua.teachers.trained.drivable_template import DrivableTemplate
from mua.teachers.trained.mesh_losses import Cloud, Samples, chamfer
from mua.teachers.trained.template_training import STAGES, Observed, fit_template, template_of
from mua.training import optimise
from mua.training.optimise import Progress
from mua.training.schedule import Schedule

ROUNDING = 1e-3  # of losses: sums in another order, which steps of Adam let grow


@pytest.fixture
def rig() -> Rig:
    return tube_rig()


def error(template: DrivableTemplate, seen: Swinging, rig: Rig) -> float:
    """The distance between the template and the true surface, metres."""
    samples = Samples.of(rig.mesh, 500)
    with torch.no_grad():
        posed = template(seen.descriptors[::4], seen.joints[::4]).posed.double()
        clouds = [Cloud.of(replace(rig.mesh, vertices=truth), 1000) for truth in seen.truth[::4]]
        away = [chamfer(own, samples, cloud, sideways=0.0) for own, cloud in zip(posed, clouds, strict=True)]
    return float(torch.stack(away).sqrt().mean())


@pytest.mark.parametrize(
    ("see", "left"), [(surfaces, 0.35), (outlines, 0.7), (tracks, 0.45)], ids=["surfaces", "outlines", "tracks"]
)
def test_the_template_is_trained_to_how_motion_deforms_it(
    rig: Rig, see: Callable[[Rig], Callable[[Array], Observed]], left: float, tmp_path: Path
) -> None:
    seen = swinging(rig, see(rig))
    skinned = error(DrivableTemplate(rig), seen, rig)
    assert skinned > 0.1 * RADIUS
    template = trained(seen, rig, SETTINGS, tmp_path)
    assert error(template, seen, rig) < left * skinned
    assert not any(parameter.requires_grad for parameter in template.parameters())


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


def test_two_processes_fit_a_template_as_one_does(tmp_path: Path) -> None:
    alone = template_losses(tmp_path / "alone")
    assert errors_of(start("template", tmp_path), "template", tmp_path) == ["", ""]
    (one, losses), (other, _) = (torch.load(tmp_path / f"template.{rank}.pt") for rank in range(2))
    assert all(torch.equal(one[name], other[name]) for name in one)
    assert losses == pytest.approx(alone[1], rel=ROUNDING)
    assert {stage for stage, _ in losses} == set(STAGES)


def test_first_the_nodes_alone_are_trained(rig: Rig, tmp_path: Path) -> None:
    seen = swinging(rig, surfaces(rig))
    run = template_run(rig, SETTINGS, tmp_path, stop_after_nodes)
    template = template_of(rig, ENCODING, SETTINGS)
    with pytest.raises(KeyboardInterrupt):
        fit_template(template, seen, rig, SETTINGS, run=run)
    state = template.state_dict()
    assert state["deformation.node_motion.weight"].abs().max() > 0
    assert state["deformation.vertex_offsets.weight"].abs().max() == 0


def stop_after_nodes(progress: Progress) -> None:
    if progress.stage == STAGES[0] and progress.step == progress.steps:
        raise KeyboardInterrupt
