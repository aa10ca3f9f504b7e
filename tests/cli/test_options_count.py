"""No option of a command is read and ignored: for every option of every command, option_tests.py names a test of it."""

import importlib
import inspect
import tomllib
from pathlib import Path

import pytest
from option_tests import HELD
from reached_options import REACHES

import mua


@pytest.mark.parametrize("command", HELD)
def test_every_option_has_a_test_that_holds_it(command: str) -> None:
    module, function, tests = HELD[command]
    parameters = inspect.signature(getattr(importlib.import_module(module), function)).parameters
    assert set(tests) == set(parameters) - {"context", "listener"}
    for file, test in (named.split(".", 1) for named in tests.values()):
        (path,) = Path(__file__).parents[1].rglob(f"test_{file}.py")
        assert f"def {test.split('[')[0]}(" in path.read_text(), f"{file}: {test}"


def test_every_command_is_in_the_table() -> None:
    commands = {one.module for one in HELD.values()} | {"mua.cli.teach"}
    with (Path(__file__).parents[2] / "python" / "pyproject.toml").open("rb") as file:
        started = tomllib.load(file)["project"]["scripts"]
    assert {entry.split(":")[0] for entry in started.values()} <= commands


def test_every_option_of_a_bake_is_followed_to_its_late_stages() -> None:
    assert set(REACHES) == set(inspect.signature(mua.bake).parameters) - {"teacher", "listener"}
