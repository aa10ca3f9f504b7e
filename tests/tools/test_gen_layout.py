"""The readers' layouts, which are generated from the schema."""

import sys

import gen_layout
import pytest


def test_the_layouts_of_all_readers_are_those_of_the_schema(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["gen_layout.py", "--check"])
    gen_layout.main()


def test_a_layout_that_is_not_that_of_the_schema_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["gen_layout.py", "--check"])
    monkeypatch.setattr(gen_layout, "generate", lambda: "")
    with pytest.raises(SystemExit, match=r"layout.py is out of date: run tools/gen_layout.py"):
        gen_layout.main()
