"""The player on the headset: installed, started and followed. docs/deploy.md lists its arguments and answers."""

import secrets
import time
from collections.abc import Generator, Iterable, Iterator
from pathlib import Path

from mua.deploy.headset import INSTALL_SECONDS, Headset, one_line
from mua.errors import InputError

PACKAGE = "com.mua.player"
ACTIVITY = "com.unity3d.player.UnityPlayerGameActivity"
STAGED = "/data/local/tmp/mua-player.apk"
TAGS = ("Unity:V", "VrApi:V", "AndroidRuntime:E", "DEBUG:F", "libc:F")
CRASHES = (f"Process: {PACKAGE},", f">>> {PACKAGE} <<<")  # in Java and in native code; the next line has the reason
PATIENCE = 60.0  # seconds without an answer after which the player is given up
TICK = 1.0  # seconds between looks at the clock while the log is silent

# Reasons of Android's package manager that have a fix of their own.
INSTALL_FIXES = {
    "INSTALL_FAILED_UPDATE_INCOMPATIBLE": f"the player there was signed with another key: 'adb uninstall {PACKAGE}' "
    "first, which deletes its avatars too",
    "INSTALL_FAILED_VERSION_DOWNGRADE": f"the player there is newer: 'adb uninstall {PACKAGE}' first, "
    "which deletes its avatars too",
    "INSTALL_FAILED_INSUFFICIENT_STORAGE": "its storage is full: delete something there",
    "INSTALL_FAILED_NO_MATCHING_ABIS": "the APK has no ARM64 code: build it with Mua.Editor.Build.Quest",
    "INSTALL_FAILED_OLDER_SDK": "its system is too old: update the headset",
    "INSTALL_PARSE_FAILED_NO_CERTIFICATES": "the APK is not signed: build it with Mua.Editor.Build.Quest",
}


def install(headset: Headset, apk: Path) -> None:
    """Put the player there, in place of an older one and with the permissions that it asks for.

    Errors: InputError if the file cannot be read or the headset refuses it.
    """
    # adbutils' own install deletes the app and its avatars when the headset refuses an update.
    content = read_apk(apk)
    try:
        headset.send(content, STAGED)
        _, text = headset.call("pm", "install", "-r", "-g", STAGED, seconds=INSTALL_SECONDS)
    finally:
        headset.call("rm", "-f", STAGED)
    if "Success" not in text.split():
        reason = next((f": {fix}" for code, fix in INSTALL_FIXES.items() if code in text), "")
        raise InputError(f"{headset.serial}: installing {apk} failed with {one_line(text) or 'no answer'}{reason}")


def read_apk(apk: Path) -> bytes:
    """The content of an APK, which is a zip archive.

    Errors: InputError naming the file.
    """
    try:
        content = apk.read_bytes()
    except OSError as error:
        raise InputError(f"{apk}: {error.strerror}") from error
    if not content.startswith(b"PK\3\4"):
        raise InputError(f"{apk}: begins with {content[:4]!r}, expected an APK")
    return content


def require_installed(headset: Headset) -> None:
    """Refuse a headset that has no player."""
    if not installed(headset):
        raise InputError(
            f"{headset.serial}: {PACKAGE} is not installed: give --apk FILE, or --project DIR to build it with Unity"
        )


def installed(headset: Headset) -> bool:
    return headset.call("pm", "path", PACKAGE)[1].startswith("package:")


def new_run() -> str:
    """An id that distinguishes the answers of this start of the player from those of any other."""
    return secrets.token_hex(4)


def start(headset: Headset, *arguments: str) -> None:
    """Restart the player with these words on its command line."""
    stop(headset)
    text = headset.run("am", "start", "-n", f"{PACKAGE}/{ACTIVITY}", "-e", "unity", " ".join(arguments))
    if "Error" in text:
        raise InputError(f"{headset.serial}: starting {PACKAGE} failed with {one_line(text)}")


def stop(headset: Headset) -> None:
    headset.run("am", "force-stop", PACKAGE)


def follow(headset: Headset, run: str, *arguments: str, patience: float | None = None) -> Generator[str, None, None]:
    """Start the player with these words and `-muaRun`, and give the lines of its log.

    Errors: InputError when it crashes, when the log ends, and when no answer of this run comes for `patience` seconds,
    PATIENCE if left out.
    """
    headset.call("logcat", "-c")  # lines that remain only cost time: answers carry the run
    start(headset, *arguments, "-muaRun", run)
    heard = time.monotonic()
    lines = headset.log(*TAGS, silence=TICK)
    for line in lines:
        if any(mark in line for mark in CRASHES):
            raise InputError(f"{headset.serial}: the player crashed: {message(next(lines, line) or line)}")
        if f" {run} " in line:
            heard = time.monotonic()
        yield line
        if time.monotonic() - heard > (PATIENCE if patience is None else patience):
            raise InputError(
                f"{headset.serial}: nothing came from the player in time: put the headset on, wake its controllers "
                "and run this again"
            )
    raise InputError(f"{headset.serial}: the log ended before the player was done: is the headset still connected?")


def answers(lines: Iterable[str], mark: str, run: str) -> Iterator[str]:
    """The player's answers in this run, without the mark and the run."""
    begin = f"{mark} {run} "
    for line in lines:
        _, found, answer = line.partition(begin)
        if found:
            yield answer.strip()


def message(line: str) -> str:
    """A line of `logcat -v time` without date, tag and process."""
    return one_line(line.partition("): ")[2] or line)
