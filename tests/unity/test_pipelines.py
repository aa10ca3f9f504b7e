"""Cameras of the built-in pipeline and of URP, in every stereo mode: what reaches the device, in which order.

Over stand-ins that call the package as the pipelines do and record what it appends; not yet verified in the editor.
"""

import base64
import functools
import itertools
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csharp import PROGRAMS, ROOT, RUNTIME, CSharp
from replay import Drawn, replay
from synthetic_avatar import synthetic_avatar, with_surface
from test_recorded_frame import MIRROR, STAND_INS

from mua.arrays import Array
from mua.asset import write
from mua.camera import EYE_DISTANCE, NEAR, Camera, orbit, stereo
from mua.decode import decode_clip_frame
from mua.gpu import Device
from mua.player.draw import SortedSplats, SplatRenderer, draw_image, image_format
from mua.rendering import render_premultiplied

sys.path.append(str(ROOT / "tests" / "parity"))

from test_frame import FRAME_ORDER, LEAST_PSNR, psnr

SPLAT, SURFACE = "Hidden/MUA/Splat", "Hidden/MUA/Surface"
WINDOW = (640, 480)  # pixels of the stand-ins' cameras
EYE = (256, 192)  # of a headset's textures
MOVED = 1  # the clip's frame in the recording's frame "moved"
DECODED = FRAME_ORDER[: FRAME_ORDER.index("SplatProject")]
SORTED = FRAME_ORDER[len(DECODED) :]
TARGETS = "color ReadWrite, depth ReadWrite"
Event = dict[str, Any]


@dataclass(frozen=True)
class Mode:
    """A pipeline and how it draws eyes."""

    pipeline: str  # builtin | urp
    stereo: str  # XRSettings.StereoRenderingMode, or None
    passes: int  # over a camera
    eyes: int  # that a pass is given
    instances: int  # that the device writes for an indirect draw
    multiplier: int  # of instances of direct draws, by the engine

    @property
    def screen(self) -> tuple[int, int]:
        return WINDOW if self.stereo == "None" else EYE

    def pass_over(self, camera: str, *, decodes: bool) -> list[str]:
        """What one pass over a camera appends."""
        compute, draw = [*(["decode"] if decodes else []), "sort"], f"draw x{self.multiplier}"
        if self.pipeline == "urp":
            foveated = "" if self.stereo == "None" else ", foveated"
            return ["MUA compute", *compute, f"MUA draw: {TARGETS}{foveated}", draw, f"submit {camera}"]
        return [*compute, draw, f"submit {camera}"]

    def camera(self, name: str, *, decodes: bool = False) -> list[str]:
        """What a camera appends; only its first pass decodes."""
        return [step for i in range(self.passes) for step in self.pass_over(name, decodes=decodes and i == 0)]

    def unseen(self, name: str) -> list[str]:
        """A camera that shows no avatar."""
        return [f"submit {name}"] * self.passes


MODES = [
    Mode("builtin", "None", 1, 1, 1, 1),
    Mode("builtin", "SinglePassInstanced", 1, 2, 2, 2),
    Mode("builtin", "SinglePassMultiview", 1, 2, 1, 1),
    Mode("builtin", "MultiPass", 2, 2, 1, 1),
    Mode("urp", "None", 1, 1, 1, 1),
    Mode("urp", "SinglePassInstanced", 1, 2, 2, 2),
    Mode("urp", "SinglePassMultiview", 1, 2, 1, 1),
    Mode("urp", "MultiPass", 2, 1, 1, 1),
]


def label(mode: Mode) -> str:
    return f"{mode.pipeline} {mode.stereo}"


def cameras() -> tuple[Camera, Camera]:
    avatar = synthetic_avatar(1)
    centres = decode_clip_frame(avatar, avatar.clips[0], frame=MOVED, dtype=np.float64).centres
    box = np.stack([centres.min(axis=0), centres.max(axis=0)])
    left, right = stereo(orbit(box, screen=EYE, azimuth=0.7, elevation=0.3), EYE_DISTANCE)
    return skewed(left, -0.1), skewed(right, 0.12)


def skewed(camera: Camera, skew: float) -> Camera:
    """Sees farther to one side, as an eye of a headset does to its own."""
    projection = camera.projection.copy()
    projection[0, 2] = skew
    return replace(camera, projection=projection)


@dataclass(frozen=True)
class Recorded:
    """A run of the program in one mode."""

    mode: Mode
    path: Path
    said: dict[str, list[str]]
    events: list[Event]

    def frames(self, name: str) -> list[list[Event]]:
        """The events of each frame of that name."""
        found: list[list[Event]] = []
        current: list[Event] | None = None
        for event in self.events:
            text = event.get("text")
            if text == f"frame {name}":
                current = []
                found.append(current)
            elif text == "end":
                current = None
            elif current is not None:
                current.append(event)
        assert found, name
        return found

    def steps(self, name: str) -> list[str]:
        """Those of a frame in words: notes, draws, and runs of kernels as decode or sort."""
        (frame,) = self.frames(name)
        return [step for step, _ in itertools.groupby(filter(None, map(step_of, frame)))]

    def draws(self, name: str) -> list[str]:
        """The shaders of a frame's draws."""
        (frame,) = self.frames(name)
        return [event["shader"] for event in frame if event["event"] == "draw"]

    def constants(self, name: str, kernel: str, constant: str) -> list[Array]:
        """What a kernel was given, each time in a frame."""
        (frame,) = self.frames(name)
        dispatches = [event for event in frame if event.get("kernel") == kernel]
        assert dispatches, f"{kernel} does not run in {name}"
        return [content(*event["constants"][constant]) for event in dispatches]


def step_of(event: Event) -> str:
    if event["event"] == "dispatch":
        return "decode" if event["kernel"] in DECODED else "sort"
    if event["event"] == "draw":
        return f"draw x{event['multiplier']}"
    return str(event["text"]) if event["event"] == "note" else ""


def content(kind: str, encoded: str) -> Array:
    return np.frombuffer(base64.b64decode(encoded), np.int32 if kind == "Int" else np.float32)


def built(csharp: CSharp, *defines: str) -> Path:
    """The program with the package and the engine's and URP's stand-ins."""
    engine = csharp.build([STAND_INS / "UnityEngine"], library=True, name="UnityEngine")
    core, universal = (f"Unity.RenderPipelines.{name}.Runtime" for name in ("Core", "Universal"))
    core_file = csharp.build([STAND_INS / core], library=True, name=core, references=[engine])
    pipeline = [engine, core_file]
    pipeline.append(csharp.build([STAND_INS / universal], library=True, name=universal, references=pipeline))
    file = csharp.build([RUNTIME / "Format"], library=True, name="Mua.Format")
    motion = csharp.build([RUNTIME / "Motion"], library=True, name="Mua.Motion", references=[file])
    package = [*sorted(RUNTIME.glob("*.cs")), RUNTIME / "Kernels", RUNTIME / "Urp"]
    sources = [*package, PROGRAMS / "shared", PROGRAMS / "PipelineProgram.cs"]
    return csharp.build(sources, references=[*pipeline, file, motion], defines=defines)


def run(csharp: CSharp, program: Path, mode: Mode, folder: Path) -> Recorded:
    write(folder / "avatar.muaavatar", with_surface(synthetic_avatar(1)), storage="f16")
    lines = ["screen {} {} {}".format(*EYE, NEAR)]
    for camera in cameras():
        numbers = np.concatenate([(camera.view @ MIRROR).ravel(), camera.projection.ravel()])
        lines.append("eye " + " ".join(repr(float(number)) for number in numbers))
    (folder / "eyes.txt").write_text("\n".join(lines))
    given = (mode.pipeline, mode.stereo, folder / "eyes.txt", folder / "avatar.muaavatar")
    said: dict[str, list[str]] = {"log": []}
    for line in csharp.run(program, ROOT / "ComputeShaders", folder / "recording", *given).splitlines():
        name, value = line.split("\t")
        said.setdefault(name, []).append(value)
    events = [json.loads(line) for line in (folder / "recording.json").read_text().splitlines()]
    return Recorded(mode, folder / "recording", said, events)


@pytest.fixture(scope="module")
def record(csharp: CSharp, tmp_path_factory: pytest.TempPathFactory) -> Callable[[Mode], Recorded]:
    """Runs a mode, once for all tests."""
    program = built(csharp)
    return functools.cache(lambda mode: run(csharp, program, mode, tmp_path_factory.mktemp("pipeline")))


@pytest.fixture(params=MODES, ids=label)
def recorded(request: pytest.FixtureRequest, record: Callable[[Mode], Recorded]) -> Recorded:
    return record(request.param)


@pytest.fixture(params=[mode for mode in MODES if mode.pipeline == "urp"], ids=label)
def universal(request: pytest.FixtureRequest, record: Callable[[Mode], Recorded]) -> Recorded:
    return record(request.param)


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
        given = [int(values[0]) for values in recorded.constants("moved", kernel, constant)]
        assert given == [expected] * times * mode.passes
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


def test_pixels_are_those_of_a_scaled_target(recorded: Recorded) -> None:
    mode = recorded.mode
    scale = np.array([0.5, 0.25 if mode.stereo == "None" else 0.5]) * (0.8 if label(mode) == "urp None" else 1)
    for given in recorded.constants("scaled", "SplatProject", "screen"):
        assert tuple(given[:2]) == tuple(np.ceil(np.multiply(mode.screen, scale)))


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
    assert sum("Compatibility Mode" in line for line in universal.said["log"]) == 1


@pytest.mark.parametrize("mode", [mode for mode in MODES if mode.pipeline == "urp"], ids=label)
def test_newer_editors_may_leave_out_what_an_eye_cannot_see(csharp: CSharp, mode: Mode, tmp_path: Path) -> None:
    """Multiview render regions, from 6000.2 on: in the first pass over a headset's camera, as URP's own objects."""
    program = built(csharp, "UNITY_6000_2_OR_NEWER")
    draws = [step for step in run(csharp, program, mode, tmp_path).steps("moved") if step.startswith("MUA draw")]
    expected = [False] if mode.stereo == "None" else [True, False][: mode.passes]
    assert ["MultiviewRenderRegionsCompatible" in step for step in draws] == expected


def test_another_pipeline_is_told_once_and_left_alone(recorded: Recorded) -> None:
    *before, last = recorded.said["log"]
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
    assert (recorded.said["alive"], recorded.said["attached"]) == (["0"], ["0"])


def test_an_avatar_that_goes_takes_its_draws_along(recorded: Recorded) -> None:
    """A pass that follows draws the others again; using a disposed buffer would end the program."""
    draws = {name: recorded.draws(name) for name in ("one of two", "one destroyed", "one left")}
    passes = recorded.mode.passes
    assert draws["one of two"] == [SURFACE, SPLAT] * passes
    assert draws["one left"] == [SPLAT] * passes
    if recorded.mode.pipeline == "builtin":
        assert draws["one destroyed"] == [SPLAT] * (passes - 1)


def test_frames_allocate_nothing(recorded: Recorded) -> None:
    assert recorded.said["allocated"] == ["0"]


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
    return SortedSplats(arguments=arguments, **held)
