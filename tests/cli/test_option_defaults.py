"""What commands do where an option is left out, and the least that an option takes, as the guides have it."""

import importlib
import inspect

import pytest


@pytest.mark.parametrize(
    ("command", "option", "default", "least"),
    [
        ("bake", "preset", "preview", None),
        ("bake", "feet", "auto", None),
        ("bake", "uv", "auto", None),
        ("bake", "recipe", "closed-form", None),
        ("bake", "storage", "f16", None),
        ("bench", "frames", 20, 1),
        ("bench", "size", "1024", None),
        ("deploy", "rate", 72, None),
        ("deploy", "seconds", None, 1),
        ("train", "preset", "preview", None),
        ("train", "recipe", "closed-form", None),
        ("train", "storage", "f16", None),
        ("view", "ipd", None, None),
    ],
)
def test_an_option_that_is_left_out(command: str, option: str, default: object, least: float | None) -> None:
    module = importlib.import_module(f"mua.cli.{command}")
    parameter = inspect.signature(getattr(module, command, None) or module.main).parameters[option]
    (given,) = getattr(parameter.annotation, "__metadata__", [None])
    assert parameter.default == default
    assert getattr(given, "min", None) == least
