"""Unity editors are found where their Hub puts them."""

import json
from pathlib import Path

import pytest

from mua.deploy.unity import choose, editor, editors, find, hub_folders, project_version
from mua.errors import InputError


def installed(folder: Path, version: str, program: str = "Editor/Unity", android: str = "Editor/Data") -> Path:
    path = folder / version / program
    path.parent.mkdir(parents=True)
    path.touch()
    if android:
        (folder / version / android / "PlaybackEngines" / "AndroidPlayer").mkdir(parents=True)
    return path


@pytest.mark.parametrize(
    ("program", "android"),
    [("Editor/Unity", "Editor/Data"), ("Editor/Unity.exe", "Editor/Data"), ("Unity.app/Contents/MacOS/Unity", ".")],
)
def test_finds_editors_of_each_platform(tmp_path: Path, program: str, android: str) -> None:
    path = installed(tmp_path, "6000.0.23f1", program, android)
    (found,) = editors([tmp_path / "absent", tmp_path])
    assert (found.program, found.version, found.android) == (path, "6000.0.23f1", True)


def test_prefers_the_version_of_the_project_else_the_newest(tmp_path: Path) -> None:
    for version in ("2022.3.50f1", "6000.0.9f1", "6000.0.23f1", "6000.10.1f1"):
        installed(tmp_path, version, android="")
    found = editors([tmp_path])
    assert choose(found, wanted="6000.0.9f1", folders=[]).version == "6000.0.9f1"
    assert choose(found, wanted="2022.3.50f1", folders=[]).version == "6000.10.1f1"


def test_names_the_folders_and_what_is_too_old(tmp_path: Path) -> None:
    installed(tmp_path, "2022.3.50f1")
    with pytest.raises(InputError, match=r"no Unity from 6000\.0 on in /hub, only 2022\.3\.50f1"):
        choose(editors([tmp_path]), folders=[Path("/hub")])


def test_hub_folders_have_the_one_that_its_user_chose(tmp_path: Path) -> None:
    chosen = tmp_path / ".config" / "UnityHub" / "secondaryInstallPath.json"
    chosen.parent.mkdir(parents=True)
    chosen.write_text(json.dumps("/big/disk"))
    assert hub_folders("linux", tmp_path, {}) == [tmp_path / "Unity/Hub/Editor", Path("/big/disk")]
    chosen.write_text("not json")
    assert len(hub_folders("linux", tmp_path, {})) == 1
    assert hub_folders("darwin", tmp_path, {})[0] == Path("/Applications/Unity/Hub/Editor")
    assert "Unity" in str(hub_folders("win32", tmp_path, {"ProgramFiles": "P"})[0])


def test_takes_the_editor_of_the_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = installed(tmp_path, "6000.0.23f1")
    monkeypatch.setenv("UNITY_EDITOR", str(path))
    assert find() == editor(path)
    monkeypatch.setenv("UNITY_EDITOR", "/absent")
    with pytest.raises(InputError, match="UNITY_EDITOR is /absent, expected the editor's program"):
        find()


def test_refuses_a_folder_that_is_no_project(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="expected a Unity project"):
        project_version(tmp_path)
