"""No option of a command is read and ignored: each alone changes what is carried out.

For every option of every command, option_tests.py names the test that fails where it is dropped on its way; those of
mua-bake, mua-train and mua-teach also change the settings that the later stages are given.
"""

import importlib
import inspect
import tomllib
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from captures import ring
from option_tests import HELD

import mua
from mua.baking.bake import read_settings
from mua.capture import Capture, CaptureClip, write_capture

BAKE: dict[str, Any] = {
    "output": "b.muaavatar",
    "character": "figure.glb",
    "motion": ["walk.bvh"],
    "hold_out": ["walk"],
    "clips": "none",
    "preset": "paper",
    "recipe": "paper",
    "frames": 9,
    "texels": 64,
    "mapping": {"hips": "pelvis"},
    "feet": "keep",
    "motion_range": "none",
    "leave_out": ["hat"],
    "uv": "unwrap",
    "detail": {"head": 2},
    "scale": 2.0,
    "height": 1.5,
    "facing": "-x",
    "turn": 30.0,
    "storage": "i8",
    "jobs": 9999,
    "seed": 3,
    "device": "cpu",
    "work": "elsewhere",
}
TRAIN: dict[str, Any] = {
    name: BAKE[name] for name in ("output", "preset", "recipe", "clips", "storage", "seed", "device", "work")
}
TRAIN["stage"] = "bases"
TEACH: dict[str, Any] = {
    "output": "other",
    "preset": "small",
    "steps": 7,
    "texels": 64,
    "drivable": True,
    "colour_correction": False,
    "refine": 2.0,
    "lpips_weights": "weights.pth",
    "rasteriser": "gsplat",
    "seed": 3,
    "device": "cpu",
}


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("figure.glb", "walk.bvh", "weights.pth"):
        Path(name).write_bytes(b"not looked into")


def defaults(function: Callable[..., Any]) -> dict[str, Any]:
    parameters = inspect.signature(function).parameters.values()
    return {one.name: one.default for one in parameters if one.default is not one.empty and one.name != "listener"}


def changed(one: Any, other: Any) -> set[str]:
    """The fields in which two settings differ."""
    return {field.name for field in fields(one) if getattr(one, field.name) != getattr(other, field.name)}


@pytest.mark.parametrize("command", HELD)
def test_every_option_has_a_test_that_holds_it(command: str) -> None:
    module, function, tests = HELD[command]
    parameters = inspect.signature(getattr(importlib.import_module(module), function)).parameters
    assert set(tests) == set(parameters) - {"context", "listener"}
    for file, test in (named.split(".", 1) for named in tests.values()):
        (path,) = Path(__file__).parents[1].rglob(f"test_{file}.py")
        assert f"def {test.split('[')[0]}(" in path.read_text(), f"{file}: {test}"


def test_every_command_is_in_the_table() -> None:
    commands = {one.module for one in HELD.values()} | {"mua.cli.teach"}
    with (Path(__file__).parents[2] / "python" / "pyproject.toml").open("rb") as file:
        started = tomllib.load(file)["project"]["scripts"]
    assert {entry.split(":")[0] for entry in started.values()} <= commands


def test_no_case_of_a_bake_stands_for_an_option_that_is_gone() -> None:
    from reached_options import REACHES as cases

    assert set(cases) == set(BAKE)


def test_every_option_of_a_bake_has_a_case() -> None:
    assert set(BAKE) == set(defaults(mua.bake)) - {"teacher"}


@pytest.mark.parametrize("option", BAKE)
def test_an_option_of_a_bake_changes_its_settings(option: str) -> None:
    given = defaults(mua.bake) | ({"motion": ["walk.bvh"]} if option == "mapping" else {})
    found = changed(read_settings(given), read_settings(given | {option: BAKE[option]}))
    assert found - {"work"} if option == "output" else len(found) == 1


@pytest.mark.parametrize("option", TRAIN)
def test_an_option_of_a_training_changes_its_settings(option: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[Any] = []
    monkeypatch.setattr(
        importlib.import_module("mua.baking.distil"), "_distil", lambda _, settings, __: found.append(settings)
    )
    recording: Any = object()
    for options in ({}, {option: TRAIN[option]}):
        mua.train(recording, **options)
    assert set(TRAIN) == set(defaults(mua.train))
    fields = changed(*found)
    assert fields - {"work"} if option == "output" else len(fields) == 1


@pytest.mark.parametrize("option", TEACH)
def test_an_option_of_a_teacher_changes_its_settings(
    option: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    cameras, clip = tuple(ring()), CaptureClip("walk", tmp_path / "walk.bvh", 0, 2)
    write_capture(
        Capture(tmp_path / "capture", "figure", 30.0, tmp_path / "figure.glb", cameras, (clip,), "{camera}/{frame}.png")
    )
    found: list[Any] = []
    monkeypatch.setattr(
        importlib.import_module("mua.baking.train_teacher"), "_train", lambda settings, *_: found.append(settings)
    )
    monkeypatch.setattr("mua.baking.train_teacher.find_spec", bool)  # gsplat is not among what tests install
    for options in ({}, {option: TEACH[option]}):
        mua.teach(tmp_path / "capture", **options)
    assert set(TEACH) == set(defaults(mua.teach))
    assert len(changed(*found)) == 1
