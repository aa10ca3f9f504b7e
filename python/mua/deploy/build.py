"""The player's APK, built by Unity without a window."""

import re
import subprocess
from pathlib import Path

from mua.deploy.headset import one_line
from mua.deploy.unity import OLDEST, Editor, release
from mua.errors import InputError

METHOD = "Mua.Editor.Build.Quest"
APK = Path("Build", "mua-player.apk")
AGAIN = re.compile(r"^MUA-BUILD AGAIN (.+)", re.MULTILINE)
AGAIN_CODE = 3  # Unity's exit code after packages or scripts were added, which its next start compiles
MOST_RUNS = 3  # one adds what is missing, one builds; one more where a package needs another

# The most informative kind of line first; of each kind the last line counts.
ERRORS = tuple(
    re.compile(pattern, re.MULTILINE)
    for pattern in (
        r"MUA-BUILD FAIL (.+)",
        r"(\S.*: error CS\d+: .+)",
        r"^(No valid Unity .*licen[sc]e.*)",
        r"(It looks like another Unity instance is running.*)",
        r"^(executeMethod .+)",
        r"^(\S*Exception: .+)",
        r"^(Error building Player.*)",
        r"^(.*\berror\b:? .+)",
        r"^Aborting batchmode due to (?:failure|fatal error):\s*(.+)",
    )
)


def build(editor: Editor, project: Path) -> Path:
    """Build the APK of a Unity project into its Build folder and return its path; Unity runs again where it asks to.

    Errors: InputError with the log's last error; no older APK is left then.
    """
    _require_able(editor)
    apk = (project / APK).resolve()
    log = apk.with_suffix(".log")
    apk.parent.mkdir(parents=True, exist_ok=True)
    apk.unlink(missing_ok=True)
    for _ in range(MOST_RUNS):
        code = _run(editor, project.resolve(), apk, log)
        if code != AGAIN_CODE:
            break
    if code != 0 or not apk.is_file():
        apk.unlink(missing_ok=True)
        if code == AGAIN_CODE:
            raise InputError(
                f"{editor.program} asked {MOST_RUNS} times to be run again, log {log}: {_brought(_text(log))}"
            )
        done = f"ended with exit code {code}" if code else "wrote no APK"
        raise InputError(f"{editor.program} {done}, log {log}: {last_error(_text(log))}")
    return apk


def last_error(log: str) -> str:
    """The line of Unity's log that best says why a build failed."""
    for kind in ERRORS:
        if found := kind.findall(log):
            return one_line(found[-1])
    return "it names no error"


def _brought(log: str) -> str:
    found = AGAIN.findall(log)
    return one_line(found[-1]) if found else "it does not say why"


def _require_able(editor: Editor) -> None:
    if editor.version and release(editor.version) < OLDEST:
        raise InputError(f"{editor.program} is version {editor.version}, expected {OLDEST[0]}.{OLDEST[1]} or newer")
    if not editor.android:
        raise InputError(f"{editor.program} has no Android module: add 'Android Build Support' with Unity Hub")


def _run(editor: Editor, project: Path, apk: Path, log: Path) -> int:
    options = ["-batchmode", "-nographics", "-quit", "-buildTarget", "Android", "-executeMethod", METHOD]
    paths = ["-projectPath", str(project), "-logFile", str(log), "-muaOutput", str(apk)]
    try:
        return subprocess.run([str(editor.program), *options, *paths], check=False, stdin=subprocess.DEVNULL).returncode
    except OSError as error:
        raise InputError(f"{editor.program} does not start: {error.strerror}") from error


def _text(log: Path) -> str:
    return log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
