"""No option of a command is read and ignored: each alone changes what is carried out."""

import importlib
import inspect
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from captures import ring

import mua
from mua.baking.options import read_order
from mua.capture import Capture, CaptureClip, write_capture

BAKE = {
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
    "storage": "i8",
    "jobs": 9999,
    "seed": 3,
    "device": "cpu",
    "work": "elsewhere",
}
TRAIN = {name: BAKE[name] for name in ("output", "preset", "recipe", "clips", "storage", "seed", "device", "work")}
TRAIN["stage"] = "bases"
TEACH = {
    "output": "other",
    "preset": "small",
    "steps": 7,
    "texels": 64,
    "drivable": True,
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
    """The fields in which two orders differ."""
    return {field.name for field in fields(one) if getattr(one, field.name) != getattr(other, field.name)}


def test_every_option_of_a_bake_has_a_case() -> None:
    assert set(BAKE) == set(defaults(mua.bake)) - {"teacher"}


@pytest.mark.parametrize("option", BAKE)
def test_an_option_of_a_bake_changes_its_order(option: str) -> None:
    given = defaults(mua.bake)
    found = changed(read_order(given), read_order(given | {option: BAKE[option]}))
    assert found - {"work"} if option == "output" else len(found) == 1


@pytest.mark.parametrize("option", TRAIN)
def test_an_option_of_a_training_changes_its_order(option: str, monkeypatch: pytest.MonkeyPatch) -> None:
    orders: list[Any] = []
    monkeypatch.setattr(
        importlib.import_module("mua.baking.train"), "_distil", lambda _, order, __: orders.append(order)
    )
    for options in ({}, {option: TRAIN[option]}):
        mua.train(object(), **options)
    assert set(TRAIN) == set(defaults(mua.train))
    found = changed(*orders)
    assert found - {"work"} if option == "output" else len(found) == 1


@pytest.mark.parametrize("option", TEACH)
def test_an_option_of_a_lesson_changes_its_order(option: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    cameras, clip = tuple(ring()), CaptureClip("walk", tmp_path / "walk.bvh", 0, 2)
    write_capture(
        Capture(tmp_path / "capture", "figure", 30.0, tmp_path / "figure.glb", cameras, (clip,), "{camera}/{frame}.png")
    )
    orders: list[Any] = []
    monkeypatch.setattr(importlib.import_module("mua.baking.teach"), "_teach", lambda order, *_: orders.append(order))
    monkeypatch.setattr("mua.baking.teach.find_spec", bool)  # gsplat is not among what tests install
    for options in ({}, {option: TEACH[option]}):
        mua.teach(tmp_path / "capture", **options)
    assert set(TEACH) == set(defaults(mua.teach))
    assert len(changed(*orders)) == 1
