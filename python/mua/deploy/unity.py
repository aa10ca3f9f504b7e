"""Unity editors on this machine: where its Hub puts them, their version, whether they build for Android."""

import json
import os
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mua.errors import InputError

OLDEST = (6000, 0)
VERSION = re.compile(r"\d+\.\d+\.\d+[abfp]\d+")
PROJECT_VERSION = Path("ProjectSettings", "ProjectVersion.txt")


@dataclass(frozen=True)
class Editor:
    """One installed editor."""

    program: Path
    version: str  # such as 6000.0.23f1; empty where its folder does not show it
    android: bool  # whether the module that builds for Android is installed


def find(unity: Path | None = None, project: Path | None = None) -> Editor:
    """The editor to build with: `unity`, else $UNITY_EDITOR, else one of the Hub's for the project, else its newest.

    Errors: InputError naming what was looked at.
    """
    given = unity or (Path(os.environ["UNITY_EDITOR"]) if os.environ.get("UNITY_EDITOR") else None)
    if given is not None:
        if not given.is_file():
            source = "--unity" if unity else "UNITY_EDITOR"
            raise InputError(f"{source} is {given}, expected the editor's program, such as Editor/Unity")
        return editor(given)
    folders = hub_folders(sys.platform, Path.home(), os.environ)
    return choose(editors(folders), wanted=project_version(project) if project else "", folders=folders)


def choose(found: list[Editor], *, wanted: str = "", folders: list[Path]) -> Editor:
    """The editor of the wanted version, else the newest that is new enough."""
    able = sorted((e for e in found if release(e.version) >= OLDEST), key=lambda e: (release(e.version), e.version))
    if not able:
        older = f", only {', '.join(e.version for e in found)}" if found else ""
        raise InputError(
            f"no Unity from {OLDEST[0]}.{OLDEST[1]} on in {', '.join(map(str, folders))}{older}: "
            "install one with Unity Hub, or give --unity"
        )
    return next((e for e in able if e.version == wanted), able[-1])


def editors(folders: list[Path]) -> list[Editor]:
    """Every editor in the Hub's folders, one folder a version."""
    programs = (_program_in(version) for folder in folders if folder.is_dir() for version in sorted(folder.iterdir()))
    return [editor(program) for program in programs if program is not None]


def editor(program: Path) -> Editor:
    """An editor described by the location of its program."""
    version = next((part for part in reversed(program.parts) if VERSION.fullmatch(part)), "")
    # Windows and Linux: Editor/Data beside the program. macOS: beside Unity.app.
    beside = (program.parent / "Data", *program.parents[3:4])
    android = any((place / "PlaybackEngines" / "AndroidPlayer").is_dir() for place in beside)
    return Editor(program, version, android)


def hub_folders(platform: str, home: Path, environment: Mapping[str, str]) -> list[Path]:
    """Where Unity Hub installs editors: its default, and the folder that its user chose."""
    if platform == "win32":
        default = Path(environment.get("ProgramFiles", "C:\\Program Files"), "Unity", "Hub", "Editor")
        settings = Path(environment.get("APPDATA", home / "AppData" / "Roaming"), "UnityHub")
    elif platform == "darwin":
        default = Path("/Applications/Unity/Hub/Editor")
        settings = home / "Library" / "Application Support" / "UnityHub"
    else:
        default = home / "Unity" / "Hub" / "Editor"
        settings = home / ".config" / "UnityHub"
    return [default, *_chosen(settings / "secondaryInstallPath.json")]


def release(version: str) -> tuple[int, ...]:
    """Numbers to order versions by; (0,) for none."""
    return tuple(map(int, re.findall(r"\d+", version))) or (0,)


def project_version(project: Path) -> str:
    """The version of Unity that a project was last opened with.

    Errors: InputError if the folder is no Unity project.
    """
    path = project / PROJECT_VERSION
    try:
        found = VERSION.search(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"--project is {project}, which has no {PROJECT_VERSION}: expected a Unity project") from error
    return found[0] if found else ""


def _program_in(version: Path) -> Path | None:
    places = ("Editor/Unity.exe", "Editor/Unity", "Unity.app/Contents/MacOS/Unity")
    return next((version / place for place in places if (version / place).is_file()), None)


def _chosen(file: Path) -> list[Path]:
    try:
        chosen = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return []
    return [Path(chosen)] if isinstance(chosen, str) and chosen else []
