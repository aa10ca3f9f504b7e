"""A bake's recording: by as many processes as asked for, reported by frame, and another where anything differs."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

from mua.baking import resumed_recording as recordings
from mua.baking.resumed_recording import recorded, recording_key
from mua.baking.settings import BakeSettings
from mua.pose.clip import Stretches
from mua.recording import PlannedClip
from mua.student.settings import preset
from mua_research import capture_training

CLIP = synthetic_avatar().clips[0]
PLANNED = PlannedClip(CLIP, held_out=False, wanted=frozenset({0, 2, 3}), whole=None)
TWISTS = np.ones((len(CLIP), 3, 3, 3))


class Heard:
    """What a listener hears."""

    def __init__(self) -> None:
        self.heard: list[tuple[Any, ...]] = []

    def stage(self, name: str) -> None:
        self.heard.append((name,))

    def step(self, done: int, total: int, *, detail: str = "") -> None:
        self.heard.append((done, total, detail))

    def note(self, sentence: str) -> None:
        self.heard.append((sentence,))


def test_it_is_made_by_as_many_processes_as_asked_for_and_told_by_frames(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: dict[str, Any] = {}

    def by_workers(
        make: object, planned: object, directory: Path, *, progress: Callable[[int, int], None], **others: Any
    ) -> None:
        asked.update(others, directory=directory)
        progress(4, 3)

    monkeypatch.setattr(recordings, "record_by_workers", by_workers)
    monkeypatch.setattr(recordings, "Recording", lambda directory: directory)
    settings = BakeSettings(tmp_path / "a.muaavatar", tmp_path / "work", preset("tiny"), jobs=3)
    listener = Heard()
    made = recorded(lambda: None, "key", settings, [PLANNED, PLANNED], listener)  # type: ignore[arg-type, return-value]
    assert made == asked["directory"] == tmp_path / "work" / "recording-key"
    assert asked["jobs"] == 3
    assert listener.heard == [("recording",), (4, 6, "3 at work")]


OTHERS: dict[str, PlannedClip] = {
    "name": replace(PLANNED, clip=replace(CLIP, name="other")),
    "held out": replace(PLANNED, held_out=True),
    "wanted frames": replace(PLANNED, wanted=frozenset({0, 2})),
    "whole frames": replace(PLANNED, whole=frozenset({0})),
    "rotations": replace(PLANNED, clip=replace(CLIP, rotations=-CLIP.rotations)),
    "translations": replace(PLANNED, clip=replace(CLIP, translations=CLIP.translations + 1)),
    "run-up": replace(PLANNED, run_up=CLIP),
    "other run-up": replace(PLANNED, run_up=replace(CLIP, translations=CLIP.translations + 1)),
    **{
        f"stretches {number}": replace(PLANNED, clip=replace(CLIP, stretches=Stretches(joints, matrices)))
        for number, (joints, matrices) in enumerate(
            [(np.arange(3), TWISTS), (np.arange(3), 2 * TWISTS), (np.array([0, 2, 1]), TWISTS)]
        )
    },
}


def test_whatever_else_it_would_be_made_of_has_another_key(monkeypatch: pytest.MonkeyPatch) -> None:
    keys = [recording_key([b"teacher"], [planned]) for planned in (PLANNED, *OTHERS.values())]
    keys += [recording_key([b"another"], [PLANNED]), recording_key([b"teacher"], [PLANNED, PLANNED])]
    assert len(set(keys)) == len(keys)
    assert recording_key([b"teacher"], [replace(PLANNED)]) == keys[0]
    for constant in ("__version__", "WAVELET"):
        monkeypatch.setattr(recordings, constant, "another")
        keys.append(recording_key([b"teacher"], [PLANNED]))
    assert len(set(keys)) == len(keys)


def test_poses_of_a_capture_are_recorded_at_one_rate_however_often_it_was_filmed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Poses at the rate of the file say all; the images' rate is no part of what is recorded."""
    rates: list[float] = []
    monkeypatch.setattr(capture_training, "record_by_workers", lambda *_, rate, **__: rates.append(rate))
    monkeypatch.setattr(capture_training, "Recording", lambda directory: directory)
    monkeypatch.setattr(capture_training, "teacher_bytes", lambda _: [b"teacher"])
    monkeypatch.setattr(capture_training, "plan_headings", lambda *_, **__: [PLANNED])
    surfaces = SimpleNamespace(skeleton=None)
    captures = [SimpleNamespace(clips=(), rate=rate, surfaces=surfaces) for rate in (25.0, 30.0, 25.0)]
    made = {capture_training._record(tmp_path, one, 9, tmp_path, Heard()) for one in captures}  # type: ignore[arg-type]
    assert (len(made), rates) == (1, [30.0, 30.0, 30.0])
