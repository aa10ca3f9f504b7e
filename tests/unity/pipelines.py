"""Cameras of stand-ins for the built-in pipeline and URP, in every stereo mode: what a run of them records.

The stand-ins call the package as the pipelines do and record what it appends; not yet verified in the editor.
"""

import base64
import itertools
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from csharp import PROGRAMS, ROOT, RUNTIME, STAND_INS, CSharp, by_name
from frame_bounds import FRAME_ORDER
from recorded_frames import eye_lines
from synthetic_avatar import synthetic_avatar, with_surface

from mua.arrays import Array
from mua.asset import write
from mua.avatar.camera import EYE_DISTANCE, Camera, orbit, stereo
from mua.avatar.decode import decode_clip_frame

SPLAT, SURFACE = "Hidden/MUA/Splat", "Hidden/MUA/Surface"
WINDOW = (640, 480)  # pixels of the stand-ins' cameras
EYE = (256, 192)  # pixels of a headset's textures
MOVED = 1  # the clip's frame in the recording's frame "moved"
DECODED = FRAME_ORDER[: FRAME_ORDER.index("SplatProject")]
SORTED = FRAME_ORDER[len(DECODED) :]
TARGETS = "color ReadWrite, depth ReadWrite"
Event = dict[str, Any]


@dataclass(frozen=True)
class Mode:
    """A pipeline and how it draws eyes."""

    pipeline: str  # builtin | urp
    stereo: str  # how both eyes are drawn, or None
    passes: int  # over a camera
    eyes: int  # that a pass is given
    instances: int  # that the device writes for an indirect draw
    multiplier: int  # the engine multiplies the instances of direct draws by this

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
    reported: dict[str, list[str]]
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
    core, universal = (f"Unity.RenderPipelines.{name}.Runtime" for name in ("Core", "Universal"))
    pipeline = [csharp.build([STAND_INS / core], library=True, name=core, references=[csharp.engine()])]
    below = [csharp.engine(), *pipeline]
    pipeline.append(csharp.build([STAND_INS / universal], library=True, name=universal, references=below))
    program = PROGRAMS / "PipelineProgram.cs"
    sources = (RUNTIME / "Urp", PROGRAMS / "shared", PROGRAMS / "scenario", program)
    return csharp.runtime(*sources, references=pipeline, defines=defines)


def run(csharp: CSharp, program: Path, mode: Mode, folder: Path) -> Recorded:
    write(folder / "avatar.muaavatar", with_surface(synthetic_avatar(1)), storage="f16")
    (folder / "eyes.txt").write_text("\n".join(eye_lines(cameras())))
    given = (mode.pipeline, mode.stereo, folder / "eyes.txt", folder / "avatar.muaavatar")
    reported = {"log": [], **by_name(csharp.run(program, ROOT / "ComputeShaders", folder / "recording", *given))}
    events = [json.loads(line) for line in (folder / "recording.json").read_text().splitlines()]
    return Recorded(mode, folder / "recording", reported, events)
