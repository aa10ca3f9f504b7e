"""Shells complete options and choices of every command, and help shows choices as choices."""

import pytest
from commands import process

from mua.evaluation.settings import SYSTEM_NAMES
from mua.student.settings import PRESETS, RECIPES
from mua_research.systems import SYSTEMS


def completed(name: str, words: str) -> list[str]:
    """What bash offers for the last of some words."""
    variable = f"_MUA_{name.upper()}_COMPLETE"
    place = str(len(words.split()) - (not words.endswith(" ")))
    return process(name, **{variable: "complete_bash", "COMP_WORDS": words, "COMP_CWORD": place}).out.split()


def test_a_shell_completes_options() -> None:
    assert completed("view", "mua-view --a") == ["--azimuth"]


def test_a_shell_completes_what_a_command_does() -> None:
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
def test_choices_are_offered_and_shown(name: str, option: str, choices: tuple[str, ...]) -> None:
    assert completed(name, f"mua-{name} {option} ") == list(choices)
    shown = process(name, "--help", COLUMNS="250").out
    assert "|".join(choices) in shown or ", ".join(choices) in shown


def test_the_choices_are_those_that_there_are() -> None:
    assert tuple(SYSTEMS) == SYSTEM_NAMES


def test_the_script_for_a_shell_is_printed() -> None:
    named = {"_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}  # there may be no shell above the tests
    assert "_MUA_INSPECT_COMPLETE" in process("inspect", "--show-completion", "zsh", **named).out
