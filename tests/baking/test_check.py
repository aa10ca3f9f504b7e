"""mua-bake --check: what it writes, prints and refuses, without baking anything."""

import json
from pathlib import Path

import gltf_files
import numpy as np
import pytest
import typer
from bvh_files import BVH
from column_files import column_file
from commands import Commands
from fbx_files import figure, picture
from PIL import Image
from rich.console import Console
from typer.testing import CliRunner

from mua.baking import check
from mua.baking.check import Check
from mua.characters.read import read_surfaces
from mua.cli.bake import main
from mua.cli.check import LOOKS_WRONG, show
from mua.errors import InputError
from mua.motion.load import load_motions
from mua.motion.mapping import read_mapping
from mua.motion.match import JointPair
from mua.motion.quality import MotionQuality
from mua.motion.reach import Reach

pytestmark = pytest.mark.usefixtures("first_try")

app = typer.Typer()
app.command()(main)


def run(*arguments: object) -> str:
    """What the command prints; its errors are raised."""
    result = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    assert result.exit_code == (LOOKS_WRONG if "Look at this" in result.output else 0)
    return result.output


@pytest.fixture
def uncompared(monkeypatch: pytest.MonkeyPatch) -> None:
    """A check lays no splats: for what it says of the files alone."""
    compare_nothing(monkeypatch)


def compare_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check, "fidelity_of", lambda *_, **__: (None, ()))


def test_leaves_a_picture_a_mapping_and_figures_and_no_avatar(tmp_path: Path) -> None:
    character, output, figures = column_file(tmp_path), tmp_path / "x" / "a.muaavatar", tmp_path / "a.json"
    text = run(character, "--motion", character, "--check", "--texels", 96, "-o", output, "--json", figures)
    assert sorted(path.name for path in output.parent.iterdir()) == ["a_check.png", "a_mapping.json"]
    with Image.open(output.parent / "a_check.png") as picture:
        assert np.asarray(picture).std() > 0
    assert read_mapping(output.parent / "a_mapping.json") == {name: name for name in ("hips", "spine", "head")}
    content = json.loads(figures.read_text())
    assert 0.9 < content["fidelity"]["iou"] < 1
    assert content["fidelity"]["psnr"] > 30
    assert [motion["name"] for motion in content["motion"]] == ["bend"]
    assert content["motion"][0]["limb_degrees"] == pytest.approx(0, abs=1e-3)
    assert {"facing_degrees", "feet_height", "slide"} <= content["motion"][0].keys()
    assert [pair["target"] for pair in content["matched"]] == ["hips", "spine", "head"]
    assert content["unmatched"] == []
    assert content["warnings"] == [sentence for sentence in content["warnings"] if sentence in text]
    assert "bend, frame 15" in text
    assert text.splitlines()[-1] == str(figures)


@pytest.mark.usefixtures("uncompared")
def test_motion_that_a_bake_refuses_is_checked_and_leaves_a_mapping_to_fill(tmp_path: Path) -> None:
    character, output = column_file(tmp_path), tmp_path / "a.muaavatar"
    motion = tmp_path / "wave.bvh"
    motion.write_text(BVH)
    with pytest.raises(InputError, match=r"wave\.bvh.*left arm.*--mapping"):
        load_motions(motion, read_surfaces(character).skeleton, mapping=None, rate=30.0)
    text = run(character, "--motion", motion, "--check", "--texels", 64, "-o", output, "--json", tmp_path / "a.json")
    (refused,) = (w for w in json.loads((tmp_path / "a.json").read_text())["warnings"] if "--mapping" in w)
    assert refused in text
    assert json.loads((tmp_path / "a_mapping.json").read_text()) == {"hips": "hips", "spine": "spine", "head": ""}
    again = motion.with_stem("again")
    for path in (motion, again):
        path.write_text(BVH.replace("Frames: 3", "Frames: 2"))
    mapping = tmp_path / "a_mapping.json"
    text = run(
        *(character, "--motion", motion, "--motion", again, "--mapping", mapping),
        *("--check", "--texels", 64, "-o", output),
    )
    assert "Clips of the motion (it moves no arm or leg, so nothing is measured): wave, again" in text
    assert "own clips" not in text
    assert "2 clips: holds 3 frames, though it says 2; all are read." in text


@pytest.mark.parametrize(("range_option", "poses"), [((), 4), (("--motion-range", "none"), 1)])
def test_a_character_without_motion_is_checked_in_poses_that_are_made_for_its_rig(
    tmp_path: Path, range_option: tuple[str, ...], poses: int
) -> None:
    character, figures = column_file(tmp_path, clip=False), tmp_path / "a.json"
    given = ("--check", "--texels", 64, "-o", tmp_path / "a.muaavatar", "--json", figures)
    text = run(character, *given, *range_option)
    assert not (tmp_path / "a_mapping.json").exists()
    assert (tmp_path / "a_check.png").exists()
    shown = [pose["pose"] for pose in json.loads(figures.read_text())["fidelity"]["poses"]]
    assert (shown[0], len(shown)) == ("as the file stands", poses)
    assert ("holds no animation" in " ".join(text.split())) is (poses > 1)


def test_the_procedural_character_is_checked_without_a_picture(tmp_path: Path) -> None:
    text = run("--check", "--texels", 64, "-o", tmp_path / "a.muaavatar")
    assert "nothing to compare" in text
    assert not list(tmp_path.iterdir())


def test_figures_without_a_check_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--json: only --check writes it"):
        run("--json", tmp_path / "a.json", "-o", tmp_path / "a.muaavatar")


def test_a_motion_format_that_is_not_read_is_refused_before_the_character_is_read(tmp_path: Path) -> None:
    character, motion = tmp_path / "hero.glb", tmp_path / "walk.c3d"
    character.touch()  # which itself would be refused
    motion.write_bytes(b"markers")
    with pytest.raises(InputError, match=r"walk\.c3d"):
        CliRunner().invoke(app, [str(character), "--motion", str(motion), "--check"], catch_exceptions=False)


def test_what_is_wrong_comes_first_and_few_joints_are_named(capsys: pytest.CaptureFixture[str]) -> None:
    joints = tuple(f"joint {number}" for number in range(12))
    pairs = tuple(JointPair(name, name, "") for name in joints[:3])
    show(Console(width=120), Check(None, (), pairs, joints[3:], ("a note",), ("the left hand is off",), ()))
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "Look at this: the left hand is off"
    assert lines[-2] == "a note"
    few = "joint 3, joint 4, joint 5, joint 6, joint 7 and 4 others"
    assert lines[-1] == f"The motion moves 3 joints, and not {few}; the mapping file names all."
    show(Console(width=120), Check(None, (), pairs[:1], (), (), (), ()))
    lines = capsys.readouterr().out.splitlines()
    assert lines == ["Nothing looks wrong.", "The motion moves 1 joint, all that have skin."]


@pytest.mark.usefixtures("uncompared")
def test_only_a_verbose_check_lists_all_joints_and_sentences(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    character, motion = column_file(tmp_path), tmp_path / "wave.bvh"
    motion.write_text(BVH)
    given = (character, "--motion", motion, "--check", "--texels", 64, "-o", tmp_path / "a.muaavatar")
    assert "Nothing moves: head." not in run(*given)
    assert "Nothing moves: head." in run(*given, "--verbose")
    many = tuple(f"limb {number} is off" for number in range(12))
    note = "joints are recognised: " + ", ".join(f"j{number} the left arm" for number in range(9)) + "."
    for verbose in (False, True):
        show(Console(width=200), Check(None, (), (), (), (note,), many, ()), verbose=verbose)
        lines = capsys.readouterr().out.splitlines()
        assert ("4 more sentences like these (--verbose prints them)." in lines) is not verbose
        assert ("Look at this: limb 11 is off" in lines) is verbose
        assert (note in lines) is verbose
        assert any(line.endswith("j2 the left arm and 6 more (--verbose lists them).") for line in lines) is not verbose


def test_a_refused_motion_is_a_short_sentence_and_verbose_names_the_joints(tmp_path: Path, command: Commands) -> None:
    character, motion = column_file(tmp_path), tmp_path / "wave.bvh"
    motion.write_text(BVH)
    given = ("bake", character, "--motion", motion, "-o", tmp_path / "a.muaavatar")
    assert "joints of the motion" not in command(*given).sentence
    ended = command(*given, "--verbose")
    assert (ended.status, ended.err.splitlines()[-1]) == (1, "joints of the character: hips, spine, head")


def test_what_is_measured_of_a_motion_is_shown_with_its_unit(capsys: pytest.CaptureFixture[str]) -> None:
    hand, foot = (
        Reach(f"left {part}", 0.1, share, ("a", "b"), ("c", "d")) for part, share in (("hand", 0.041), ("foot", 0.02))
    )
    walk = MotionQuality(
        "walk", 1.24, 12.4, -0.0126, 0.333, {"left thigh": 1.25}, -3.4, {"left hand": 8.2}, (hand, foot), ()
    )
    wave = MotionQuality("wave", 0.0, None, None, None, {"left thigh": 0.0}, None, {}, (), ())
    show(Console(width=120), Check(None, (walk, wave), (), (), (), (), ()))
    rows = [line.replace("│", " ").split() for line in capsys.readouterr().out.splitlines()]
    assert ["walk", "1.2°", "4%", "8°", "-3°", "12°", "-0.013", "m", "0.33", "m/s"] in rows
    assert ["wave", "0.0°"] in rows


def test_a_lost_texture_is_among_what_looks_wrong(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fbx, _, body = figure()
    fbx.texture(fbx.material(body), "c:/textures/Cloth_01.png")
    hero, figures = fbx.save(tmp_path / "hero.fbx"), tmp_path / "hero.json"
    text = run(hero, "--check", "--texels", 64, "-o", tmp_path / "hero.muaavatar", "--json", figures)
    found = json.loads(figures.read_text())
    assert "in one colour (put them beside the file): Cloth_01.png." in found["warnings"][0]
    assert not any("Cloth_01" in note for note in found["notes"])
    assert text.index("Look at this: Textures that are neither in the file nor beside it") == text.index("Look at this")
    compare_nothing(monkeypatch)
    (tmp_path / "cloth_01.png").write_bytes(picture((10, 60, 200, 255)))
    assert "Cloth_01" not in run(hero, "--check", "--texels", 64, "-o", tmp_path / "hero.muaavatar")


@pytest.mark.usefixtures("uncompared")
def test_a_figure_of_one_colour_that_has_places_for_pictures_looks_wrong(tmp_path: Path) -> None:
    says = "Look at this: The whole character is drawn in one colour"
    output = tmp_path / "a.muaavatar"
    assert says in run(gltf_files.body().save(tmp_path / "bare.glb"), "--check", "--texels", 64, "-o", output)
    clay = gltf_files.body(TEXCOORD_0=None).save(tmp_path / "clay.glb")
    assert says not in run(clay, "--check", "--texels", 64, "-o", output)
    assert says not in run(column_file(tmp_path), "--check", "--texels", 64, "-o", output)


def test_leaves_names_of_expressions_to_correct(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    character, output = tmp_path / "hero.glb", tmp_path / "a.muaavatar"
    lean = np.where(gltf_files.POINTS[:, 1:2] > 1, [[0.1, 0, 0]], 0)
    glb = gltf_files.body()
    gltf_files.primitive(glb)["targets"] = [{"POSITION": glb.accessor(lean)}, {"POSITION": glb.accessor(-lean)}]
    glb.json["meshes"][0]["extras"] = {"targetNames": ["Fcl_MTH_A", "mund"]}
    glb.save(character)
    with monkeypatch.context() as patch:
        compare_nothing(patch)
        run(character, "--check", "--texels", 64, "-o", output)
    names = tmp_path / "a_expressions.json"
    assert json.loads(names.read_text()) == {"Fcl_MTH_A": "aa", "mund": ""}
    names.write_text(json.dumps({"Fcl_MTH_A": "aa", "mund": "jawOpen"}))
    figures = tmp_path / "a.json"
    run(character, "--check", "--texels", 64, "-o", output, "--json", figures, "--expression-names", names)
    assert [*json.loads(figures.read_text())["fidelity"]["expressions"]] == ["at rest", "Fcl_MTH_A", "jawOpen"]
