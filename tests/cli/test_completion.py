"""Shells complete options and choices of every command, and help shows choices as choices."""

from collections.abc import Callable

import pytest
from commands import Commands, process

from mua.evaluation.settings import SYSTEM_NAMES
from mua.student.settings import PRESETS, RECIPES
from mua_research.systems import SYSTEMS

Completed = Callable[[str, str], list[str]]  # what bash offers for the last of some words


@pytest.fixture
def completed(command: Commands, monkeypatch: pytest.MonkeyPatch) -> Completed:
    def run(name: str, words: str) -> list[str]:
        place = str(len(words.split()) - (not words.endswith(" ")))
        asked = {f"_MUA_{name.upper()}_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": place}
        with monkeypatch.context() as patch:
            for variable, value in asked.items():
                patch.setenv(variable, value)
            return command(name).out.split()

    return run


def test_a_shell_completes_options(completed: Completed) -> None:
    assert completed("view", "mua-view --a") == ["--azimuth"]


def test_a_shell_completes_what_a_command_does(completed: Completed) -> None:
    assert "check" in completed("capture", "mua-capture ")
    assert completed("capture", "mua-capture check --fr") == ["--frames"]


@pytest.mark.parametrize(
    ("name", "option", "choices"),
    [
        ("bake", "--preset", tuple(PRESETS)),
        ("train", "--recipe", RECIPES),
        ("bench", "--preset", tuple(PRESETS)),
        ("eval", "--system", ("all", *SYSTEM_NAMES)),
    ],
)
def test_choices_are_offered_and_shown(
    completed: Completed,
    command: Commands,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    option: str,
    choices: tuple[str, ...],
) -> None:
    assert completed(name, f"mua-{name} {option} ") == list(choices)
    monkeypatch.setenv("COLUMNS", "250")
    shown = command(name, "--help").out
    assert "|".join(choices) in shown or ", ".join(choices) in shown


def test_the_choices_are_those_that_there_are() -> None:
    assert tuple(SYSTEMS) == SYSTEM_NAMES


def test_the_script_for_a_shell_is_printed() -> None:
    named = {"_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}  # there may be no shell above the tests
    assert "_MUA_INSPECT_COMPLETE" in process("inspect", "--show-completion", "zsh", **named).out
