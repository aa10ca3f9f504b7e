"""What a machine and a headset lack, each with its fix."""

import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from adbutils import AdbClient, AdbError, adb_path

from mua.asset.read import read
from mua.deploy.headset import Headset, attached, connect, one_line
from mua.deploy.player import PACKAGE, installed
from mua.deploy.unity import OLDEST, find, release
from mua.errors import InputError

OLDEST_API = 32  # Android API level for which the Unity project builds the player (ProjectPlayer.cs)
LOW_BATTERY = 20  # percent
LINK_RUNTIME = "oculus_openxr_64.json"
OPENXR_KEY = "SOFTWARE\\Khronos\\OpenXR\\1"


@dataclass(frozen=True)
class Check:
    """One thing that was looked at; `fix` is a sentence unless it is ok."""

    name: str
    state: Literal["ok", "missing", "wrong"]
    found: str
    fix: str = ""


def examine(
    avatars: list[Path],
    *,
    serial: str | None = None,
    unity: Path | None = None,
    project: Path | None = None,
) -> list[Check]:
    """Every check that applies here. A headset is looked into only where one is ready."""
    checks = [_adb(), _server(), *_headset(serial), *_unity(unity, project)]
    if sys.platform == "win32":
        checks.append(openxr_runtime(_active_runtime()))
    return checks + [_avatar(path) for path in avatars]


def openxr_runtime(active: str | None) -> Check:
    """Whether a PC's OpenXR programs show on a headset that is linked."""
    fix = "choose 'Set Meta Horizon Link as active' in the Link app's settings, General, and restart the editor"
    if active is None:
        return Check("OpenXR runtime", "missing", "none", f"install Meta Horizon Link, then {fix}")
    if LINK_RUNTIME not in active.lower():
        return Check("OpenXR runtime", "wrong", active, fix)
    return Check("OpenXR runtime", "ok", active)


def _adb() -> Check:
    fix = "install Android's platform tools and put adb on the PATH"
    try:
        path = adb_path()
        shown = subprocess.run([path, "version"], capture_output=True, text=True, check=True, timeout=20).stdout
    except AdbError:
        return Check("adb", "missing", "", fix)
    except (OSError, subprocess.SubprocessError) as error:
        return Check("adb", "wrong", one_line(str(error)), fix)
    versions = [line.split()[-1] for line in shown.splitlines() if "ersion " in line]
    return Check("adb", "ok", f"{' '.join(versions)} at {path}")


def _server() -> Check:
    client = AdbClient()
    try:
        attached(client)
        return Check("adb server", "ok", f"version {client.server_version()} at {client.host}:{client.port}")
    except InputError as error:
        return Check("adb server", "missing", f"{client.host}:{client.port}", str(error))


def _headset(serial: str | None) -> list[Check]:
    try:
        seen = attached(AdbClient())
    except InputError:
        return []
    shown = ", ".join(f"{each} {'no permissions' if state == 'no' else state}" for each, state in seen.items())
    try:
        headset = connect(serial)
    except InputError as error:
        return [Check("headset", "wrong" if seen else "missing", shown, str(error))]
    return [Check("headset", "ok", shown), *(_asked(look, headset) for look in (_system, _battery, _player))]


def _asked(look: Callable[[Headset], Check], headset: Headset) -> Check:
    try:
        return look(headset)
    except InputError as error:
        return Check("headset", "wrong", "", str(error))


def _system(headset: Headset) -> Check:
    names = ("ro.product.model", "ro.build.version.release", "ro.build.version.sdk", "ro.build.display.id")
    model, android, api, build = (headset.run("getprop", name) for name in names)
    found = f"{model}, Android {android} (API {api}), {build}"
    if not api.isdecimal() or int(api) < OLDEST_API:
        return Check("system", "wrong", found, f"update the headset: the player needs API {OLDEST_API} or newer")
    return Check("system", "ok", found)


def _battery(headset: Headset) -> Check:
    pairs = (line.partition(":") for line in headset.run("dumpsys", "battery").splitlines())
    level = next((value.strip() for key, _, value in pairs if key.strip() == "level"), "")
    if not level.isdecimal():
        return Check("battery", "missing", "", "restart the headset: it does not tell its level")
    if int(level) < LOW_BATTERY:
        return Check("battery", "wrong", f"{level} %", "charge the headset: it slows down when the battery is low")
    return Check("battery", "ok", f"{level} %")


def _player(headset: Headset) -> Check:
    if not installed(headset):
        return Check("player", "missing", "", "install it: mua-deploy --apk FILE, or --project DIR to build it")
    shown = headset.run("dumpsys", "package", PACKAGE).split()
    version = next((word.partition("=")[2] for word in shown if word.startswith("versionName=")), "")
    return Check("player", "ok", f"{PACKAGE} {version}".strip())


def _unity(unity: Path | None, project: Path | None) -> list[Check]:
    try:
        editor = find(unity, project)
    except InputError as error:
        return [Check("Unity", "missing", "", f"{error}; not needed with --apk")]
    found = f"{editor.version or 'unknown version'} at {editor.program}"
    if editor.version and release(editor.version) < OLDEST:
        wanted = f"{OLDEST[0]}.{OLDEST[1]}"
        return [Check("Unity", "wrong", found, f"install {wanted} or newer with Unity Hub; not needed with --apk")]
    if not editor.android:
        fix = "add 'Android Build Support' with Unity Hub; not needed with --apk"
        return [Check("Unity", "ok", found), Check("Android module", "missing", "", fix)]
    return [Check("Unity", "ok", found), Check("Android module", "ok", "")]


def _avatar(path: Path) -> Check:
    try:
        avatar = read(path)
    except InputError as error:
        return Check(path.name, "wrong" if path.exists() else "missing", "", f"bake it anew: {error}")
    return Check(path.name, "ok", f"{avatar.name}, {path.stat().st_size / 1e6:.1f} MB")


def _active_runtime() -> str | None:
    if sys.platform != "win32":
        return None
    import winreg  # other systems have none

    try:
        with winreg.OpenKey(winreg.HKEY_LOCAL_MACHINE, OPENXR_KEY) as key:
            return str(winreg.QueryValueEx(key, "ActiveRuntime")[0])
    except OSError:
        return None
