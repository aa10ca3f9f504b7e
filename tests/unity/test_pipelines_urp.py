"""What only URP does with cameras, in every stereo mode: scales, stacks, culling, newer editors; and the picture."""

import itertools
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from csharp import CSharp
from frame_bounds import LEAST_PSNR, psnr
from pipelines import EYE, MODES, MOVED, Mode, Recorded, built, cameras, label, run, step_of
from replay import Drawn, replay
from synthetic_avatar import synthetic_avatar

from mua.avatar.decode import decode_clip_frame
from mua.avatar.rendering import render_premultiplied
from mua.gpu import Device
from mua.player.draw import SortedSplats, SplatRenderer, draw_image, image_format


@pytest.mark.parametrize(
    "mode", [mode for mode in MODES if mode.pipeline == "urp" and mode.stereo != "None"], ids=label
)
def test_a_headset_has_a_scale_of_its_own(record: Callable[[Mode], Recorded], mode: Mode) -> None:
    """URP foveates its own passes by that one, and does not merge ours with those unless we do the same."""
    recorded = record(mode)
    for frame, scale, is_foveated in (
        ("scaled", 0.5, True),
        ("scaled on a Quest", 0.5, False),
        ("scaled without a copy on a Quest", 0.5, True),
        ("whole on a Quest", 1, True),
    ):
        draws = [step for step in recorded.steps(frame) if step.startswith("MUA draw")]
        assert ["foveated" in step for step in draws] == [is_foveated] * mode.passes
        for given in recorded.constants(frame, "SplatProject", "screen"):
            assert tuple(given[:2]) == tuple(np.ceil(np.multiply(EYE, scale)))


def test_overlay_cameras_and_other_renderers_draw_avatars(universal: Recorded) -> None:
    mode = universal.mode
    assert universal.steps("own renderer") == [*mode.camera("main", decodes=True), *mode.camera("other")]
    passes = [mode.pass_over(name, decodes=False) for _ in range(mode.passes) for name in ("main", "other")]
    expected = list(itertools.chain(*passes))
    assert universal.steps("overlay") == [expected[0], "decode", *expected[1:]]


def test_passes_of_a_camera_that_was_culled_are_not_drawn_by_the_next(universal: Recorded) -> None:
    assert universal.steps("culled") == universal.mode.camera("other", decodes=True)
    assert universal.steps("culled before another") == universal.mode.unseen("other")[:1]


def test_a_camera_of_depth_alone_draws_nothing(universal: Recorded) -> None:
    assert not [step for step in universal.steps("depth only") if "draw" in step]


def test_compatibility_mode_is_refused_once(universal: Recorded) -> None:
    assert [step_of(event) for frame in universal.frames("compatibility") for event in frame] == [
        f"submit {name}" for _ in range(2 * universal.mode.passes) for name in ("main", "other")
    ]
    assert sum("Compatibility Mode" in line for line in universal.reported["log"]) == 1


@pytest.mark.parametrize("mode", [mode for mode in MODES if mode.pipeline == "urp"], ids=label)
def test_newer_editors_may_leave_out_what_an_eye_cannot_see(csharp: CSharp, mode: Mode, tmp_path: Path) -> None:
    """Multiview render regions, from 6000.2 on: in the first pass over a headset's camera, as URP's own objects."""
    program = built(csharp, "UNITY_6000_2_OR_NEWER")
    draws = [step for step in run(csharp, program, mode, tmp_path).steps("moved") if step.startswith("MUA draw")]
    expected = [False] if mode.stereo == "None" else [True, False][: mode.passes]
    assert ["MultiviewRenderRegionsCompatible" in step for step in draws] == expected


@pytest.mark.parametrize("stereo_mode", ["SinglePassInstanced", "MultiPass"])
def test_the_picture_is_that_of_the_cpu_rasteriser(
    record: Callable[[Mode], Recorded], device: Device, stereo_mode: str
) -> None:
    """Of every eye of URP's frame "moved", by what its draws were bound to."""
    mode = next(mode for mode in MODES if (mode.pipeline, mode.stereo) == ("urp", stereo_mode))
    recorded, avatar = record(mode), synthetic_avatar(1)
    exact = decode_clip_frame(avatar, avatar.clips[0], frame=MOVED, dtype=np.float64)
    (frame,) = recorded.frames("moved")
    before = itertools.takewhile(lambda event: event is not frame[0], recorded.events)
    first = sum(event["event"] == "draw" for event in before)
    draws = replay(device, recorded.path).draws[first : first + mode.passes]
    assert len(draws) == mode.passes
    for index, drawn in enumerate(draws):
        seen = cameras() if mode.eyes == 2 else (cameras()[index],)
        assert drawn.arguments[1] == mode.instances
        image = draw_image(device, SplatRenderer(device, image_format(device)), uploaded(device, drawn), seen)
        for found, camera in zip(np.split(image, mode.eyes, axis=1), seen, strict=True):
            assert psnr(found, render_premultiplied(exact, camera)) > LEAST_PSNR


def uploaded(device: Device, drawn: Drawn) -> SortedSplats:
    """What a draw was bound to, for the desktop player's."""
    words = np.array([drawn.arguments[0], 1, 0, 0], np.uint32)
    held = {name: device.buffer(drawn.buffers[name], name=name) for name in ("splats", "order")}
    arguments = device.buffer(words, name="arguments", indirect=True)
    return SortedSplats(arguments=arguments, corners=drawn.corners, **held)
