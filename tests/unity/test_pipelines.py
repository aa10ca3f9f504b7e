"""Cameras of the built-in pipeline and of URP, in every stereo mode: what reaches the device, in which order."""

import numpy as np
import pytest
from pipelines import DECODED, MODES, SORTED, SPLAT, SURFACE, Recorded, cameras, label

from mua.avatar.camera import NEAR


def test_a_frame_decodes_sorts_and_draws_for_a_camera(recorded: Recorded) -> None:
    mode = recorded.mode
    assert recorded.steps("moved") == mode.camera("main", decodes=True)
    (frame,) = recorded.frames("moved")
    kernels = [event["kernel"] for event in frame if event["event"] == "dispatch"]
    assert kernels == [*DECODED, *SORTED * mode.passes]


def test_what_stands_still_is_only_sorted(recorded: Recorded) -> None:
    assert recorded.steps("still") == recorded.mode.camera("main")


def test_opaque_views_are_drawn_before_splats_and_bones_after(recorded: Recorded) -> None:
    (frame,) = recorded.frames("all views")
    draws = [event for event in frame if event["event"] == "draw"]
    order = [(SURFACE, 0), (SURFACE, 1), (SPLAT, 0), (SURFACE, 2)]
    assert [(event["shader"], event["pass"]) for event in draws] == order * recorded.mode.passes
    assert ["indices" in event for event in draws] == [True, True, False, False] * recorded.mode.passes


def test_the_device_is_told_of_eyes_instances_and_pixels(recorded: Recorded) -> None:
    mode = recorded.mode
    for kernel, constant, expected, times in (
        ("SplatProject", "eyes", mode.eyes, 1),
        ("ScatterDigits", "instances", mode.instances, SORTED.count("ScatterDigits")),
    ):
        firsts = [int(values[0]) for values in recorded.constants("moved", kernel, constant)]
        assert firsts == [expected] * times * mode.passes
    for given in recorded.constants("moved", "SplatProject", "screen"):
        assert tuple(given[:2]) == mode.screen
    for given in recorded.constants("moved", "SplatProject", "near"):
        assert given[0] == np.float32(NEAR)


def test_each_pass_is_given_its_eyes(recorded: Recorded) -> None:
    """In the kernels' right-handed world; a single eye stands in both places."""
    mode = recorded.mode
    expected = [[0, 1]] if mode.eyes == 2 else [[eye, eye] for eye in range(mode.passes)]
    if mode.passes == 2 and mode.eyes == 2:
        expected = [[0, 1]] * 2  # the engine says which is drawn
    for name in ("view", "projection"):
        given = recorded.constants("moved", "SplatProject", name)
        for found, eyes in zip(given, expected, strict=True):
            for matrix, eye in zip(found.reshape(2, 4, 4), eyes, strict=True):
                np.testing.assert_allclose(matrix.T, getattr(cameras()[eye], name), atol=1e-6)


@pytest.mark.parametrize(("frame", "share"), [("scaled", 0.5), ("scaled between pixels", 0.33)])
def test_pixels_are_those_of_a_scaled_target(recorded: Recorded, frame: str, share: float) -> None:
    """Those that are covered in part too."""
    mode = recorded.mode
    scale = np.array([share, share**2 if mode.stereo == "None" else share]) * (0.8 if label(mode) == "urp None" else 1)
    for given in recorded.constants(frame, "SplatProject", "screen"):
        assert tuple(given[:2]) == tuple(np.ceil(np.multiply(mode.screen, scale)))


def test_a_second_camera_sorts_after_the_first_has_drawn(recorded: Recorded) -> None:
    mode = recorded.mode
    assert recorded.steps("two") == [*mode.camera("main", decodes=True), *mode.camera("other")]


def test_the_scene_view_and_reflections_see_avatars_by_one_eye(recorded: Recorded) -> None:
    """URP draws the scene view by its default renderer, whatever the camera says."""
    mode = recorded.mode
    for name in ("scene view", "reflection", *(["scene view with settings"] if mode.pipeline == "urp" else [])):
        steps = recorded.steps(name)[len(mode.camera("main")) + 1 :]
        mono = next(other for other in MODES if label(other) == f"{mode.pipeline} None")
        assert steps == mono.camera("other")


@pytest.mark.parametrize("name", ["preview", "other layers"])
def test_cameras_that_show_no_avatar_cost_nothing(recorded: Recorded, name: str) -> None:
    mode = recorded.mode
    unseen = ["submit other"] if name == "preview" else mode.unseen("other")
    assert recorded.steps(name)[len(mode.camera("main")) + 1 :] == unseen[:1]


def test_an_orthographic_camera_draws_no_splats(recorded: Recorded) -> None:
    steps = recorded.steps("orthographic")[len(recorded.mode.camera("main")) + 1 :]
    assert not [step for step in steps if step.startswith(("sort", "draw"))]


def test_another_pipeline_is_told_once_and_left_alone(recorded: Recorded) -> None:
    *before, last = recorded.reported["log"]
    assert "OtherPipelineAsset cannot draw avatars" in last
    assert len(before) == (recorded.mode.pipeline == "urp")
    assert not [step for step in recorded.steps("other pipeline") if not step.startswith("submit")]


def test_a_device_without_indirect_draws_is_told_how_many(recorded: Recorded) -> None:
    """Of one eye: the engine multiplies them."""
    (frame,) = recorded.frames("direct")
    draws = [event for event in frame if event["event"] == "draw"]
    assert len(draws) == recorded.mode.passes
    for draw in draws:
        assert (draw["instances"], draw["multiplier"]) == (1, recorded.mode.multiplier)


def test_avatars_that_go_while_a_camera_is_rendered_are_not_drawn(recorded: Recorded) -> None:
    assert recorded.draws("destroyed") == recorded.draws("empty") == []
    assert recorded.steps("empty") == recorded.mode.unseen("main")[:1]
    assert (recorded.reported["alive"], recorded.reported["attached"]) == (["0"], ["0"])


def test_an_avatar_that_goes_takes_its_draws_along(recorded: Recorded) -> None:
    """A pass that follows draws the others again; using a disposed buffer would end the program."""
    draws = {name: recorded.draws(name) for name in ("one of two", "one destroyed", "one left")}
    passes = recorded.mode.passes
    assert draws["one of two"] == [SURFACE, SPLAT] * passes
    assert draws["one left"] == [SPLAT] * passes
    if recorded.mode.pipeline == "builtin":
        assert draws["one destroyed"] == [SPLAT] * (passes - 1)


def test_frames_allocate_nothing(recorded: Recorded) -> None:
    assert recorded.reported["allocated"] == ["0"]
