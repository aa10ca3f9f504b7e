"""The browser player's modules one by one, with stand-ins for page, player and headset, run by Node's test runner."""

import subprocess
from pathlib import Path

import pytest
from web.test_modules import SECONDS, pytestmark

__all__ = ["pytestmark"]  # skips where Node is missing

UNITS = sorted(Path(__file__).parent.glob("units/*.test.mjs"))


@pytest.mark.parametrize("file", UNITS, ids=[file.name.split(".")[0] for file in UNITS])
def test_a_module_does_what_its_tests_say(file: Path) -> None:
    command = ["node", "--no-warnings", "--test-reporter=spec", str(file)]
    ran = subprocess.run(command, capture_output=True, text=True, check=False, timeout=SECONDS)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert "tests 0" not in ran.stdout
