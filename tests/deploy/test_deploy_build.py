"""The APK comes from Unity's batch mode; where it does not, the log's last error is reported."""

from pathlib import Path

import pytest
from fake_unity import fake_unity, project

from mua.deploy.build import build, last_error
from mua.deploy.unity import editor
from mua.errors import InputError


def test_writes_the_apk_into_the_project(tmp_path: Path) -> None:
    program = fake_unity(tmp_path, 'echo "$arguments" > "$log"; echo apk > "$apk"')
    root = project(tmp_path)
    apk = build(editor(program), root)
    assert apk == root / "Build" / "mua-player.apk"
    log = apk.with_suffix(".log").read_text()
    for words in (
        "-batchmode",
        "-buildTarget Android",
        "-executeMethod Mua.Editor.Build.Quest",
        f"-projectPath {root}",
    ):
        assert words in log


def test_runs_again_where_unity_brought_packages(tmp_path: Path) -> None:
    first = (
        f'echo "MUA-BUILD AGAIN added com.unity.xr.openxr" > "$log"; echo half > "$apk"; touch "{tmp_path}/ran"; exit 3'
    )
    apk = build(
        editor(fake_unity(tmp_path, f'[ -e "{tmp_path}/ran" ] || {{ {first}; }}; echo whole > "$apk"')),
        project(tmp_path),
    )
    assert apk.read_text() == "whole\n"


def test_gives_up_where_unity_always_asks_to_run_again(tmp_path: Path) -> None:
    does = f'echo x >> "{tmp_path}/runs"; echo "MUA-BUILD AGAIN added a package" > "$log"; exit 3'
    with pytest.raises(InputError, match=r"asked 3 times to be run again, log .*: added a package"):
        build(editor(fake_unity(tmp_path, does)), project(tmp_path))
    assert (tmp_path / "runs").read_text() == "x\n" * 3


@pytest.mark.parametrize(
    ("does", "sentence"),
    [
        (
            'echo "Assets/A.cs(3,5): error CS0246: no type X" > "$log"; exit 1',
            "exit code 1, log .*: Assets.* CS0246: no",
        ),
        ('echo half > "$apk"; echo "MUA-BUILD FAIL no scene" > "$log"; exit 2', "exit code 2, log .*: no scene"),
        ("exit 0", "wrote no APK, log .*: it names no error"),
    ],
)
def test_reports_the_last_error_and_leaves_no_apk(tmp_path: Path, does: str, sentence: str) -> None:
    root = project(tmp_path)
    old = root / "Build" / "mua-player.apk"
    old.parent.mkdir()
    old.write_bytes(b"old")
    with pytest.raises(InputError, match=sentence):
        build(editor(fake_unity(tmp_path, does)), root)
    assert not old.exists()


def test_refuses_an_old_editor_and_one_without_android(tmp_path: Path) -> None:
    root = project(tmp_path)
    with pytest.raises(InputError, match=r"is version 2022\.3\.1f1, expected 6000\.0 or newer"):
        build(editor(fake_unity(tmp_path, "exit 0", version="2022.3.1f1")), root)
    with pytest.raises(InputError, match="add 'Android Build Support'"):
        build(editor(fake_unity(tmp_path, "exit 0", android=False)), root)


def test_refuses_a_program_that_does_not_start(tmp_path: Path) -> None:
    program = fake_unity(tmp_path, "exit 0")
    program.chmod(0o644)
    with pytest.raises(InputError, match="does not start: Permission denied"):
        build(editor(program), project(tmp_path))


@pytest.mark.parametrize(
    ("log", "best"),
    [
        ("error: a\nX.cs(1,1): error CS1: b\nX.cs(2,1): error CS2: c\nScripts have compiler errors.", "CS2: c"),
        ("BuildFailedException: no OpenXR loader\n  at A ()\nBuild failed with error: 1", "no OpenXR loader"),
        ("Aborting batchmode due to failure:\nexecuteMethod class 'Build' could not be found.", "could not be found"),
        ("No valid Unity Editor license found. Please activate", "license found"),
        ("Aborting batchmode due to fatal error:\nout of disk", "out of disk"),
        ("all went well\n", "it names no error"),
    ],
)
def test_chooses_the_most_informative_line(log: str, best: str) -> None:
    assert best in last_error(log)
    assert "\n" not in last_error(log)
