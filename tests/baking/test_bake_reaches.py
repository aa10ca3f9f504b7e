"""Every option of mua-bake reaches the stage that it is for, in a bake and in a check: run by its command line.

Recording, training and comparison, which take minutes, are stand-ins that keep what they are given.
"""

import json
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from unittest.mock import Mock

import gltf_files
import numpy as np
import pytest
import torch
from bvh_files import BVH
from commands import Commands
from people import person, walk
from reached_options import FIGURE, MAPPED, REACHES, WALK, Late

from mua.baking import check, pipeline
from mua.baking.distillation import Distillation
from mua.baking.settings import BakeSettings
from mua.cli.check import LOOKS_WRONG
from mua.export.bvh import bvh_text
from mua.fidelity import fitting
from mua.pose.clip import Clip
from mua.recording import PlannedClip
from mua.rig.character import Character

pytestmark = pytest.mark.usefixtures("first_try")

BAKED = (
    "output",
    "preset",
    "budget_mflop",
    "budget_mb",
    "frames",
    "hold_out",
    "clips",
    "motion_range",
    "recipe",
    "storage",
    "device",
    "jobs",
    "work",
)


class Reached(Exception):
    """The last stage began."""


def with_hat(directory: Path) -> None:
    """A column with two clips and an expression, and a second column beside it that is called hat and is of felt."""
    glb = gltf_files.body()
    lean = np.where(gltf_files.POINTS[:, 1:2] > 1, [[0.1, 0, 0]], 0)
    gltf_files.primitive(glb)["targets"] = [{"POSITION": glb.accessor(lean)}]
    glb.json["meshes"][0]["extras"] = {"targetNames": ["jawOpen"]}
    glb.json["materials"] = [{"name": "felt"}]
    glb.json["meshes"].append({"name": "hat", "primitives": [gltf_files.primitive(glb) | {"material": 0}]})
    glb.json["nodes"].append({"mesh": 1, "skin": 0, "name": "hat", "translation": [0.5, 0, 0]})
    glb.json["scenes"][0]["nodes"].append(4)
    time = glb.accessor(np.linspace(0, 1, 2))
    turn = glb.accessor(np.array([[0, 0, 0, 1], [0, 0, np.sin(0.3), np.cos(0.3)]]))
    sampled = {"samplers": [{"input": time, "output": turn}]}
    glb.json["animations"] = [
        {"name": name, "channels": [{"sampler": 0, "target": {"node": node, "path": "rotation"}}], **sampled}
        for node, name in ((1, "bend"), (2, "nod"))
    ]
    glb.save(directory / "figure.glb")


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("reaches")
    with_hat(directory)
    (directory / "walk.bvh").write_text(bvh_text(person(), walk(person(size=1.0))))
    rows = (f"00:00:0{k // 60}:{k % 60},1,{min(k / 4, 1)}\n" for k in range(120))  # at 60 Hz
    (directory / "talk.csv").write_text("Timecode,BlendShapeCount,JawOpen\n" + "".join(rows))
    (directory / "names.json").write_text(json.dumps({"jawOpen": "aa"}))
    directions = np.zeros((16, 3, 20))
    directions[:, 1, 10] = gltf_files.POINTS[:, 1] / 100  # the first of the expressions
    np.savez(directory / "model.npz", v_template=gltf_files.POINTS, shapedirs=directions)
    for name in ("wave", "sway"):
        (directory / f"{name}.bvh").write_text(BVH.replace("spine", "thing"))
    for name, joint in (("spine", "spine"), ("head", "head")):
        (directory / f"{name}.json").write_text(json.dumps({"hips": "hips", joint: "thing"}))
    return directory


@pytest.fixture(scope="module")
def ran() -> dict[tuple[str, ...], Late]:
    """What was run before, by its arguments."""
    return {}


@pytest.fixture
def run(
    files: Path, ran: dict[tuple[str, ...], Late], command: Commands, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Late]:
    """The command up to its late stages, with arguments."""
    monkeypatch.chdir(files)
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)  # so that --device cpu is a choice

    def bake(*arguments: str) -> Late:
        if arguments in ran:
            return ran[arguments]
        late = ran[arguments] = Late()

        def compared(
            character: Character, clips: list[Clip], *, texels: int, teacher: object = None, process: object = None
        ) -> tuple[None, tuple[str, ...]]:
            late.character, late.clips, late.compared = character, tuple(clips), texels
            return None, ()

        def teacher(
            character: Character, *, texels: int, laid: object = None, lit_in: object = None, seed: int = -1
        ) -> None:
            late.character, late.texels, late.seed = character, texels, seed

        def recorded(
            make: Callable[[], None], _: str, settings: BakeSettings, planned: list[PlannedClip], *__: object
        ) -> None:
            make()
            late.recorded_with, late.planned = settings, tuple(planned)

        def distil_student(distillation: Distillation, *_: object) -> None:
            late.distillation, late.clips = distillation, distillation.clips or ()
            raise Reached

        for module in (pipeline, check):
            monkeypatch.setattr(module, "fidelity_of", compared)
        monkeypatch.setattr(pipeline, "StillTeacher", Mock())
        monkeypatch.setattr(fitting, "fit", lambda *_, **__: np.zeros((1, 9)))
        monkeypatch.setattr(pipeline, "SimulatedTeacher", teacher)
        monkeypatch.setattr(pipeline, "waiting_workers", lambda *_: nullcontext([]))
        monkeypatch.setattr(pipeline, "recorded", recorded)
        monkeypatch.setattr(pipeline, "distil_student", distil_student)
        shown = ("--check",) if "--check" in arguments else ()
        texels = () if "--texels" in arguments else ("--texels", "64")
        try:
            ended = command("bake", *(one for one in arguments if one != "--check"), *texels, *shown)
        except Reached:
            return late
        assert shown, ended.err
        assert ended.status == (LOOKS_WRONG if "Look at this" in ended.out else 0), ended.err
        return late

    return bake


CASES = [(name, checked) for name in REACHES for checked in (False, True) if not (checked and name in BAKED)]


@pytest.mark.parametrize(
    ("option", "checked"), CASES, ids=lambda value: {True: "check", False: "bake"}.get(value, value)
)
def test_an_option_is_seen_in_what_the_late_stages_get(run: Callable[..., Late], option: str, checked: bool) -> None:
    before, value, shown, expected = REACHES[option]
    flag = () if option == "character" else (f"--{option.replace('_', '-')}",)
    mode = ("--check",) if checked else ()
    given = shown(run(*mode, *before, *flag, value))
    other = {"mapping": MAPPED, "motion": ("--motion", "sway.bvh")}.get(option, ())
    assert given != shown(run(*mode, *before, *other))
    assert expected is None or given == expected


@pytest.mark.parametrize("checked", [False, True])
def test_motion_on_a_bakes_character_goes_where_its_check_showed_it(run: Callable[..., Late], checked: bool) -> None:
    """What a check says of feet is said of the clip that the bake records."""
    kept, planted = (run(*["--check"] * checked, *WALK, "--feet", feet).clips[0] for feet in ("keep", "plant"))
    same = run(*["--check"] * (not checked), *WALK, "--feet", "plant").clips[0]
    np.testing.assert_array_equal(planted.rotations, same.rotations)
    assert np.abs(planted.rotations - kept.rotations).max() > 1e-3


def test_the_seed_is_that_of_teacher_and_student(run: Callable[..., Late]) -> None:
    late = run(*FIGURE, "--seed", "5")
    assert (late.seed, late.settings.seed) == (5, 5)


def test_the_recording_lies_in_the_work_directory(run: Callable[..., Late]) -> None:
    settings = run(*FIGURE, "--work", "there").recorded_with
    assert settings
    assert settings.work == Path("there")


def test_a_check_writes_its_figures_beside_what_was_asked_for(
    files: Path, run: Callable[..., Late], tmp_path: Path
) -> None:
    run("--check", *FIGURE, "--json", str(tmp_path / "figures.json"))
    assert json.loads((tmp_path / "figures.json").read_text())["character"] == "figure.glb"
