"""The tests that the package brings for people with an editor, its menu and its builds, run by mono over stand-ins."""

import shutil
from collections.abc import Callable
from pathlib import Path

import gen_golden
import pytest
from csharp import PROGRAMS, ROOT, CSharp, by_name
from golden import read_golden
from package_compiler import PACKAGE, Compiler
from replay import replay

from mua.gpu import Device

KERNELS = ROOT / "ComputeShaders"
CASES = len(read_golden())
ASSEMBLIES = ("UnityEngine", "UnityEditor", "UnityEngine.TestRunner", "nunit.framework", "Mua.Format", "Mua.Motion")
OURS = ("Mua.Avatar", "Mua.Avatar.SelfTest", "Mua.Avatar.Editor", "Mua.Avatar.Tests", "Mua.Avatar.Editor.Tests")
Reports = dict[str, list[str]]
Story = Callable[..., Reports]


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    compiler = Compiler(csharp, "editor", packages=False)
    references = [compiler.built(name) for name in (*ASSEMBLIES, *OURS)]
    sources = [PROGRAMS / "shared", PROGRAMS / "PackageTestsProgram.cs"]
    return csharp.build(sources, name="PackageTestsProgram", references=references)


@pytest.fixture
def story(csharp: CSharp, program: Path) -> Story:
    def tell(name: str, *, package: object = PACKAGE, recording: object = "-", answered: object = "-") -> Reports:
        reported = by_name(csharp.run(program, package, KERNELS, recording, answered, name))
        assert reported["alive"] == ["0"], reported
        return reported

    return tell


def outcomes(reported: Reports) -> dict[str, str]:
    """What came of each test."""
    return {key.removeprefix("test "): value for key, (value, *_) in reported.items() if key.startswith("test ")}


@pytest.fixture
def answered(device: Device, tmp_path: Path) -> Callable[[Story, str], Reports]:
    """A story reported again, with what its recording makes of the buffers that it reads."""

    def tell(story: Story, name: str) -> Reports:
        recording, folder = tmp_path / "recorded", tmp_path / "answers"
        story(name, recording=recording)
        folder.mkdir()
        for label, words in replay(device, recording).kept.items():
            (folder / f"{label}.bin").write_bytes(words.tobytes())
        return story(name, answered=folder)

    return tell


def test_every_edit_mode_test_passes(story: Story, answered: Callable[[Story, str], Reports]) -> None:
    found = outcomes(answered(story, "EditMode"))
    assert len(found) == CASES + 1
    assert set(found.values()) == {"passed"}


def test_edit_mode_tests_can_fail(story: Story) -> None:
    found = outcomes(story("EditMode"))
    assert all("wanted" in value for name, value in found.items() if name != "GoldenFilesArePresent")


def test_edit_mode_tests_say_that_the_golden_files_are_missing(story: Story, tmp_path: Path) -> None:
    for package in ("-", tmp_path):
        found = outcomes(story("EditMode", package=package))
        assert list(found) == ["GoldenFilesArePresent"]
        assert "without the self-test's files" in found["GoldenFilesArePresent"]


def test_edit_mode_tests_say_why_they_are_skipped(story: Story) -> None:
    skipped = [value for value in outcomes(story("EditModeWithoutCompute")).values() if value != "passed"]
    assert len(skipped) == CASES
    assert all(value.startswith("IgnoreException needs a device with compute") for value in skipped)


def test_every_play_mode_test_passes(story: Story) -> None:
    found = outcomes(story("PlayMode"))
    assert len(found) == 3
    assert set(found.values()) == {"passed"}, found


def test_the_menu_says_how_many_cases_passed(story: Story, answered: Callable[[Story, str], Reports]) -> None:
    reported = answered(story, "Menu")
    assert reported["dialog"] == [f"{CASES} of {CASES} cases passed on stand-in."]
    assert reported["Log"][-1] == f"MUA-SELFTEST editor PASS {CASES}/{CASES}"
    assert story("Menu")["dialog"] == [f"0 of {CASES} cases passed on stand-in; the console lists the others."]


def test_the_menu_says_that_the_golden_files_are_missing(story: Story) -> None:
    assert "without the self-test's files" in story("Menu", package="-")["dialog"][0]


def test_builds_of_the_player_hold_the_golden_files(story: Story, tmp_path: Path) -> None:
    names = sorted(f"{stem}{ending}" for stem in gen_golden.CASES for ending in (".json", ".bin"))
    packed = tmp_path / "package" / "Tests" / "Golden~"
    shutil.copytree(gen_golden.GOLDEN, packed)
    for package, folder in ((PACKAGE, gen_golden.GOLDEN), (tmp_path / "package", packed)):
        reported = story("Builds", package=package)
        assert sorted(reported["of the player"]) == sorted(f"MuaGolden/{name} {folder / name}" for name in names)
        assert "of another" not in reported


def test_a_build_without_golden_files_says_so(story: Story) -> None:
    reported = story("Builds", package="-")
    assert "of the player" not in reported
    assert "without the self-test's files" in reported["Warning"][0]
