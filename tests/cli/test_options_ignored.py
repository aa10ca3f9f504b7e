"""Where a command ignores an option, the test fails that option_tests.py names for it."""

import importlib
import inspect
import os
import subprocess
import sys
from pathlib import Path

import pytest
from option_tests import HELD

TESTS = Path(__file__).parents[1]
EAGER = {"list_devices"}  # carried out before its command begins, which cannot ignore it


def optional() -> list[tuple[str, str]]:
    """Every command with each option that may be left out; without the others it would not begin."""
    found = []
    for command, (module, function, _) in HELD.items():
        arguments = inspect.signature(getattr(importlib.import_module(module), function)).parameters.values()
        found += [(command, one.name) for one in arguments if one.default is not one.empty]
    return [(command, option) for command, option in found if option not in {*EAGER, "listener"}]


@pytest.mark.long
@pytest.mark.parametrize(("command", "option"), optional())
def test_a_test_fails_where_an_option_is_ignored(command: str, option: str, tmp_path: Path) -> None:
    module, function, tests = HELD[command]
    file, test = tests[option].split(".", 1)
    path = os.pathsep.join([str(TESTS / "ignored_option"), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "PYTHONPATH": path, "IGNORED_OPTION": f"{module}:{function}:{option}"}
    line = [
        sys.executable,
        "-m",
        "pytest",
        "-c",
        str(TESTS.parent / "pyproject.toml"),
        "-x",
        "-n0",
        "-p",
        "no:randomly",
    ]
    ended = subprocess.run(
        [*line, "-p", "no:cacheprovider", f"{next(TESTS.rglob(f'test_{file}.py'))}::{test}"],
        cwd=tmp_path, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ended.returncode == pytest.ExitCode.TESTS_FAILED, f"{ended.stdout}\n{ended.stderr}"
