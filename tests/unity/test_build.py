"""The batch build in stand-ins of the editor: what it writes, what it says, and what it leaves behind."""

import json
import re
from pathlib import Path

import pytest
from csharp import CSharp
from package_compiler import PACKAGE
from package_content import Content
from project_program import ProjectProgram, Reports

from mua.deploy.build import AGAIN, ERRORS


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> ProjectProgram:
    return ProjectProgram(csharp)


def outcome(reported: Reports) -> str:
    """What mua-deploy reads: the last line of the log, without its kind."""
    return reported["log"][-1].split(" ", 1)[1]


def assert_project_is_left(reported: Reports) -> None:
    assert (reported["identifier"], reported["bundle"], reported["player"]) == (
        ["org.example.own"],
        ["True"],
        ["False"],
    )


def test_writes_the_apk_under_its_name_at_last(program: ProjectProgram, tmp_path: Path) -> None:
    apk = tmp_path / "Build" / "mua-player.apk"
    reported = program.tell("Builds", "Quest", "succeeds", "-muaOutput", apk)
    assert reported["ended"] == ["Done"]
    assert [path.name for path in apk.parent.iterdir()] == ["mua-player.apk"]
    assert apk.read_text() == "whole"
    assert reported["location"] == [str(apk.with_name("mua-player.apk.part") / "mua-player.apk")]
    assert (reported["scene"], reported["scenes"]) == (["Assets/MUA/Player.unity"], ["Assets/MUA/Player.unity"])
    assert (reported["built as"], reported["built as player"], reported["options"]) == (
        ["com.mua.player"],
        ["True"],
        ["None"],
    )
    assert re.fullmatch(rf"MUA-BUILD OK {re.escape(str(apk))}, 0\.0 MB, \d+ s", outcome(reported))
    assert_project_is_left(reported)


def test_a_development_build_is_asked_for(program: ProjectProgram, tmp_path: Path) -> None:
    reported = program.tell("Builds", "Quest", "succeeds", "-muaDevelopment", "-muaOutput", tmp_path / "a.apk")
    assert (reported["ended"], reported["options"]) == (["Done"], ["Development"])


@pytest.mark.parametrize(
    ("does", "sentence"),
    [
        ("fails", "Unity's build ended as Failed with 7 errors: see the lines above"),
        ("throws", "InvalidOperationException: out of disk"),
    ],
)
def test_a_build_that_fails_leaves_nothing(program: ProjectProgram, tmp_path: Path, does: str, sentence: str) -> None:
    apk = tmp_path / "mua-player.apk"
    apk.write_text("old")
    reported = program.tell("Builds", "Quest", does, "-muaOutput", apk)
    assert reported["ended"] == ["Failed"]
    assert outcome(reported) == f"MUA-BUILD FAIL {sentence}"
    assert ERRORS[0].findall("\n".join(reported["log"])) == [sentence]
    assert not list(tmp_path.iterdir())
    assert_project_is_left(reported)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "the command line has no -muaOutput PATH, expected where to write the player"),
        (["-muaOutput"], "the command line has no -muaOutput PATH, expected where to write the player"),
        (["-muaOutput", "-quit"], "the command line has no -muaOutput PATH, expected where to write the player"),
        (["-muaOutput", "{}/player.aab"], "-muaOutput is {}/player.aab, expected a file name that ends in .apk"),
        (["-muaOutput", "{}/taken.apk"], "-muaOutput is {}/taken.apk, which is a folder, expected a file name"),
        (["-muaOutput", "{}/file/player.apk"], "-muaOutput is {}/file/player.apk, which cannot be written: "),
    ],
)
def test_refuses_an_output_that_is_none(
    program: ProjectProgram, tmp_path: Path, words: list[str], sentence: str
) -> None:
    (tmp_path / "taken.apk").mkdir()
    (tmp_path / "file").write_text("in the way")
    reported = program.tell("Builds", "Quest", "succeeds", *(word.format(tmp_path) for word in words))
    assert reported["ended"] == ["Failed"]
    assert outcome(reported).startswith(f"MUA-BUILD FAIL {sentence.format(tmp_path)}")
    assert "location" not in reported


def test_windows_gets_a_folder(program: ProjectProgram, tmp_path: Path) -> None:
    folder = tmp_path / "Player"
    folder.mkdir()
    (folder / "mua-player.exe").write_text("old")
    (folder / "old.dll").write_text("old")
    reported = program.tell("Builds", "PcLink", "succeeds", "-muaOutput", folder)
    assert reported["ended"] == ["Done"]
    assert [path.name for path in tmp_path.iterdir()] == ["Player"]
    assert {path.name for path in folder.iterdir()} == {"mua-player.exe", "mua-player.exe.symbols.zip"}
    reported = program.tell("Builds", "PcLink", "fails", "-muaOutput", f"{folder}/")
    assert reported["ended"] == ["Failed"]
    assert not list(tmp_path.iterdir())


def test_windows_never_deletes_what_is_not_the_player(program: ProjectProgram, tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("mine")
    reported = program.tell("Builds", "PcLink", "succeeds", "-muaOutput", tmp_path)
    assert outcome(reported) == (
        f"MUA-BUILD FAIL -muaOutput is {tmp_path}, which holds something else than the player, "
        "expected a new folder's name"
    )
    assert (tmp_path / "thesis.txt").read_text() == "mine"


def test_brings_the_sample_and_packages_in_one_run(program: ProjectProgram, tmp_path: Path) -> None:
    words = ("Quest", "succeeds", "-muaOutput", tmp_path / "a.apk")
    reported = program.tell("Builds", *words, sample=False)
    assert (reported["ended"], reported["imported"]) == (["Again"], ["True"])
    assert AGAIN.findall(outcome(reported)) == ["imported the sample VR Player"]
    reported = program.tell("Builds", *words, sample=False, packages=False)
    assert (reported["ended"], reported["imported"]) == (["Again"], ["True"])
    assert "com.unity.xr.openxr" in AGAIN.findall(outcome(reported))[0]
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("state", "sentence"),
    [
        ("absent", "package com.mua.avatar has no sample 'VR Player': reinstall the package"),
        (
            "imported",
            "the sample 'VR Player' in Assets/Samples/MUA Avatar/0.1.0/VR Player has no "
            "Mua.Samples.VrPlayer.Editor.PlayerScene: delete that folder and run again",
        ),
    ],
)
def test_says_what_is_wrong_with_the_sample(program: ProjectProgram, tmp_path: Path, state: str, sentence: str) -> None:
    output = ("-muaOutput", tmp_path / "a.apk")
    reported = program.tell("BringsSample", state, "Quest", "succeeds", *output, sample=False)
    assert (reported["ended"], outcome(reported)) == (["Failed"], f"MUA-BUILD FAIL {sentence}")


def test_a_project_that_cannot_be_set_up_is_not_built(program: ProjectProgram, tmp_path: Path) -> None:
    reported = program.tell("BuildsForOther", tmp_path / "a.apk")
    assert reported["ended"] == ["Failed"]
    assert outcome(reported) == (
        "MUA-BUILD FAIL Build > Platform is StandaloneLinux64, expected Android: start Unity with -buildTarget Android"
    )
    assert "location" not in reported


def test_ends_the_editor_with_the_outcome(program: ProjectProgram) -> None:
    reported = program.tell("RunsFromCommandLine")
    assert reported["exit"] == ["exit 1"]
    assert outcome(reported).startswith("MUA-BUILD FAIL the command line has no -muaOutput PATH")


@pytest.mark.parametrize(("name", "output"), [("Quest", "a.apk"), ("PC Link", "Player")])
def test_each_command_builds_for_its_platform(program: ProjectProgram, tmp_path: Path, name: str, output: str) -> None:
    reported = program.tell("RunsWithoutModule", name, "-muaOutput", tmp_path / output)
    assert outcome(reported).startswith(f"MUA-BUILD FAIL This editor cannot build for {name}: ")


def test_the_sample_has_what_the_build_looks_for(content: Content) -> None:
    samples = json.loads((PACKAGE / "package.json").read_text())["samples"]
    assert "VR Player" in [sample["displayName"] for sample in samples]
    assert "Mua.Samples.VrPlayer.Editor.PlayerScene.Create" in content.declared["member"]
