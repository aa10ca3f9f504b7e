"""`make demo` installs what the demo needs and nothing of the tests; `make package` needs Python alone."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NEEDED = ("sh", "env", "dirname", "mkdir", "touch", "true")
OF_TESTS = {"flatbuffers-compiler", "glslang-tools", "mono-mcs", "mono-runtime", "xvfb"}
# Stand-ins write down how they are called; find sees an empty machine.
STANDINS = {
    "apt-get": 'echo "apt-get $*" >> "$CALLS"',
    "id": "echo 0",
    "find": ":",
    "grep": "exit 1",
    "python": """case "$1" in -c) exit "${OLD:-0}" ;; esac
case "$2" in venv) mkdir -p "$3/bin"; cp "$0" "$3/bin/python" ;; *) echo "$*" >> "$CALLS" ;; esac""",
}


def set_up(purpose: str, folder: Path, **given: str) -> tuple[int, str, str]:
    """Run the set-up on a machine without anything; its status, calls and errors."""
    programs, calls = folder / "programs", folder / "calls"
    programs.mkdir()
    for name in (*NEEDED, "cp"):
        (programs / name).symlink_to(shutil.which(name) or "/bin/true")
    for name, script in STANDINS.items():
        (programs / name).write_text(f"#!/bin/sh\n{script}\n")
        (programs / name).chmod(0o755)
    environment = {"PATH": str(programs), "CALLS": str(calls), "PYTHON": "python", **given}
    command = ["/bin/sh", str(ROOT / "tools" / "setup.sh"), "venv", purpose]
    ended = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    return ended.returncode, calls.read_text() if calls.exists() else "", ended.stderr


def debian_packages(calls: str) -> set[str]:
    installs = [line for line in calls.splitlines() if line.startswith("apt-get install")]
    return {word for line in installs for word in line.split()[2:] if not word.startswith("-")}


def test_the_demo_installs_nothing_of_the_tests(tmp_path: Path) -> None:
    status, calls, errors = set_up("demo", tmp_path)
    assert (status, errors) == (0, "")
    assert debian_packages(calls) == {"g++", "mesa-vulkan-drivers"}
    assert "./python[bake,view]" in calls
    assert "dev]" not in calls
    assert "research" not in calls


def test_the_tests_get_what_they_need(tmp_path: Path) -> None:
    status, calls, errors = set_up("test", tmp_path)
    assert (status, errors) == (0, "")
    assert debian_packages(calls) > OF_TESTS
    assert "./python[dev] -e ./python/research" in calls


def test_an_old_python_is_refused(tmp_path: Path) -> None:
    status, calls, errors = set_up("demo", tmp_path, OLD="1")
    assert (status, calls) == (1, "")
    assert "expected 3.11 or later" in errors


def test_the_package_for_unity_needs_python_alone(tmp_path: Path) -> None:
    copied = (
        "Makefile",
        "tools",
        "unity-package",
        "ComputeShaders",
        "docs/unity.md",
        "tests/parity/golden",
        "tests/golden",
    )
    for name in copied:
        target = tmp_path / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(ROOT / name, target)
    if shutil.which("make") is None:
        pytest.skip("needs make")
    command = ["make", "package", f"PYTHON={sys.executable} -S -E"]
    ended = subprocess.run(command, cwd=tmp_path, env=os.environ, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    assert list((tmp_path / "build").glob("com.mua.avatar-*.tgz"))
    assert not (tmp_path / ".venv").exists()
