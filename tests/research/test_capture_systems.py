"""Compared systems at several sizes, the largest at equal cost, and how ours stands among them."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import torch
from compared_systems import few
from empty_entries import nothing
from PIL import Image

from mua.avatar.decode import pose_splats
from mua.evaluation.capture_report import sheet_names, student_of
from mua.evaluation.capture_scores import TRAINED, UNSEEN, FilmedEntry, Judged, Shot
from mua.evaluation.cost import Cost, learnt_cost
from mua.evaluation.metrics import Scores
from mua.recording import Recording
from mua.training.checkpoint import Checkpoints
from mua_research import capture_systems
from mua_research.capture_systems import STEPS_OF_TWO, Sized, cost_of, largest_within, sized, trained_entries
from mua_research.curve import COSTS, curve, points
from mua_research.network import Forgetful
from mua_research.standing import best, sentences, standings
from mua_research.system import Budget, Sizes, Training, TrainingFrames
from mua_research.systems import SYSTEMS


@pytest.mark.parametrize("name", SYSTEMS)
def test_parameters_and_operations_grow_with_the_scale(name: str, smooth_frames: TrainingFrames) -> None:
    costs = [cost_of(Sized(name, scale), smooth_frames.sizes) for scale in (0.25, 1, 4)]
    assert [a.within(b) for a, b in pairwise(costs)] == [True, True]
    assert [b.within(a) for a, b in pairwise(costs)] == [False, False]


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_system_of_another_size_learns_and_is_taken_up_again(name: str, smooth_frames: TrainingFrames) -> None:
    frames = few(smooth_frames)
    for scale in (0.5, 2):
        system = SYSTEMS[name](replace(frames.sizes, scale=scale))
        system.fit(frames, Budget(steps=1, batch=4), torch.Generator().manual_seed(1), lambda _: None)
        again = SYSTEMS[name](replace(frames.sizes, scale=scale))
        again.restore(system.state(), frames)
        assert (
            system.network.parameter_count()
            == again.network.parameter_count()
            != SYSTEMS[name](frames.sizes).parameters
        )
        motion = frames.motion.of(torch.arange(3))
        assert torch.equal(again.textures(motion), system.textures(motion))


@pytest.mark.parametrize("name", SYSTEMS)
def test_the_largest_size_within_a_cost_is_followed_by_one_beyond(name: str, smooth_frames: TrainingFrames) -> None:
    most = cost_of(Sized(name, 1.5), smooth_frames.sizes)
    (found,) = largest_within(name, most, smooth_frames.sizes)
    assert cost_of(found, smooth_frames.sizes).within(most)
    larger = replace(found, scale=found.scale * 2 ** (1 / STEPS_OF_TWO))
    assert not cost_of(larger, smooth_frames.sizes).within(most)


def test_no_size_is_within_a_cost_of_nothing(smooth_frames: TrainingFrames) -> None:
    assert largest_within("linear", Cost(1, 1), smooth_frames.sizes) == []
    assert not Cost().within(Cost(1, 1))


def test_every_system_is_there_at_every_scale_and_at_equal_cost_once(smooth_frames: TrainingFrames) -> None:
    sizes: Sizes = smooth_frames.sizes
    found = sized(["ours", "linear"], [2.0, 1.0], sizes)
    assert [one.name for one in found if one.system == "ours"] == ["ours", "ours x2"]
    theirs = [one for one in found if one.system == "linear"]
    assert {1.0, 2.0} < {one.scale for one in theirs}
    assert [one.scale for one in theirs] == sorted(one.scale for one in theirs)
    costs = [(one.system, cost_of(one, sizes)) for one in found]
    assert len(set(costs)) == len(costs)


def test_sizes_that_come_to_the_same_are_there_once_by_their_first_name(smooth_frames: TrainingFrames) -> None:
    """Systems in the order in which they are asked for; ours at no other scale than those that are."""
    found = sized(["pca-only", "ours", "linear"], [2.0, 2.0001], smooth_frames.sizes)
    assert list(dict.fromkeys(one.system for one in found)) == ["pca-only", "ours", "linear"]
    assert [one.name for one in found if one.system == "ours"] == ["ours x2"]
    scales = [one.scale for one in found]
    assert (2.0 in scales, 2.0001 in scales) == (True, False)


def test_a_system_is_shown_as_it_learnt_and_one_that_fails_is_told(
    smooth_recording: Recording, smooth_frames: TrainingFrames, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(sizes: Sizes) -> object:
        system = SYSTEMS["linear"](sizes)
        monkeypatch.setattr(system, "fit", lambda *_: 1 / 0)
        return system

    monkeypatch.setattr(capture_systems, "SYSTEMS", {**SYSTEMS, "single-level": broken})
    frames, begun, failed = few(smooth_frames), list[str](), list[str]()
    entries = trained_entries(
        [Sized("single-level", 1.0), Sized("linear", 2.0)],
        Training(frames, Budget(steps=1), Forgetful(Path(), ""), lambda _: None),
        begin=begun.append,
        failed=failed.append,
    )
    (entry,) = entries
    assert begun == ["single-level", "linear x2"]
    assert failed == ["single-level: ZeroDivisionError: division by zero"]
    assert (entry.name, entry.system, entry.scale) == ("linear x2", "linear", 2.0)
    assert entry.cost == cost_of(Sized("linear", 2.0), frames.sizes)
    (clip,) = (clip for clip in smooth_recording.clips if clip.name == "walk")
    (recorded,) = (frame for frame in smooth_recording.whole_frames(held_out=False) if frame.index == 20)
    shown = entry.show(clip, recorded.index)
    mean = frames.mean_texture.numpy()
    assert np.square(shown.texture - recorded.texture).sum() < 0.5 * np.square(mean - recorded.texture).sum()
    assert np.abs(shown.canonical - recorded.mesh).max() < 0.2 * np.ptp(recorded.mesh)
    now, first = (
        pose_splats(frames.rig, recorded.mesh, texture=recorded.texture, pose=clip.pose(frame)).centres
        for frame in (recorded.index, 0)
    )
    assert np.abs(shown.centres - now).mean() < 0.5 * np.abs(first - now).mean()


def test_each_size_of_a_system_is_taken_up_where_it_was_left(smooth_frames: TrainingFrames, tmp_path: Path) -> None:
    frames = few(smooth_frames)
    wanted, failed, steps = [Sized("linear", 1.0), Sized("linear", 2.0)], list[str](), list[int]()
    checkpoints = Checkpoints(tmp_path, "key")
    for _ in range(2):
        entries = trained_entries(
            wanted,
            Training(frames, Budget(steps=1), checkpoints, lambda progress: steps.append(progress.step)),
            begin=lambda _: steps.append(0),
            failed=failed.append,
        )
        assert [one.cost for one in entries] == [cost_of(one, frames.sizes) for one in wanted]
    assert failed == []
    assert steps == [0, 1, 0, 1, 0, 0]  # the second time nothing is trained


def entry(name: str, cost: Cost, *, system: str = "", scale: float = 1.0) -> FilmedEntry:
    return FilmedEntry(name, nothing, cost, system, scale)


ENTRIES = [
    entry("teacher", Cost()),
    entry("file", Cost(1, 1)),
    entry("ours", learnt_cost(20, 20), system="ours"),
    entry("ours x2", learnt_cost(30, 30), system="ours", scale=2),
    entry("small", learnt_cost(20, 10), system="pca-only", scale=0.5),
    entry("smaller", learnt_cost(10, 10), system="linear"),
    entry("large", learnt_cost(10, 21), system="pca-only"),
]
PSNR = {  # two views of each split
    TRAINED: {"teacher": (50, 50), "file": (49, 49), "ours": (31, 28), "ours x2": (40, 40), "small": (29, 29),
              "smaller": (20, 20), "large": (45, 45)},
    UNSEEN: {"teacher": (50, 50), "file": (49, 49), "ours": (25, 25), "ours x2": (40, 40), "small": (24, 24),
             "smaller": (26, 26), "large": (45, 45)},
}  # fmt: skip


def views() -> list[Judged]:
    return [
        Judged(
            Shot(split, "clip", view, "cam"),
            {},
            {name: Scores(float(values[view]), 0.9, np.nan, 0.1, np.nan) for name, values in own.items()},
        )
        for split, own in PSNR.items()
        for view in range(2)
    ]


def test_ours_stands_among_systems_that_cost_at_most_as_much() -> None:
    known, unseen = standings(views(), ENTRIES)
    assert (known.split, known.rival, known.difference, known.ahead, known.views) == (TRAINED, "small", 0.5, 1, 2)
    assert (unseen.split, unseen.rival, unseen.difference, unseen.ahead) == (UNSEEN, "smaller", -1.0, 0)
    first, last = sentences([known, unseen])
    assert "ours is first: +0.50 dB, nearer in 1 of 2 images, than small" in first
    assert "ours is NOT first: -1.00 dB" in last
    assert standings(views(), [one for one in ENTRIES if one.system != "ours"]) == []
    assert standings(views(), ENTRIES[:4]) == []
    assert best(views(), [], TRAINED) is None


def test_a_sheet_shows_what_is_no_system_then_ours_then_the_rival() -> None:
    assert sheet_names(ENTRIES[::-1], "small") == ["file", "teacher", "ours", "small"]
    assert sheet_names(ENTRIES[:2], None) == ["teacher", "file"]
    assert student_of(ENTRIES).name == "ours"
    assert student_of(ENTRIES[:2]).name == "file"


def test_the_curve_has_a_point_for_each_size_of_a_system(tmp_path: Path) -> None:
    by_parameters, by_operations = COSTS.values()
    assert points(views(), ENTRIES, "pca-only", TRAINED, by_parameters) == [(1e-5, 45.0), (2e-5, 29.0)]
    assert points(views(), ENTRIES, "pca-only", TRAINED, by_operations) == [(1e-5, 29.0), (2.1e-5, 45.0)]
    assert points(views(), ENTRIES, "single-level", TRAINED, by_operations) == []
    heights = []
    alone = [Judged(one.shot, {}, {k: v for k, v in one.scores.items() if k != "teacher"}) for one in views()[:2]]
    for split, shown in ((views(), ENTRIES), (alone, [one for one in ENTRIES if one.name != "teacher"])):
        (tmp_path / "curve.png").write_bytes(curve(split, shown))
        with Image.open(tmp_path / "curve.png") as plot:
            heights.append(plot.height)
            assert np.asarray(plot).std() > 5
    assert heights[0] == 2 * heights[1]  # a row for each split that has views
