"""The package's commands, run within a test or as processes of their own, and what they leave when they end."""

import importlib
import os
import subprocess
import sys
from dataclasses import dataclass

import pytest


@dataclass(frozen=True)
class Ended:
    """A command that has ended."""

    status: int
    out: str
    err: str

    @property
    def sentence(self) -> str:
        """The one error that a command ends with."""
        assert (self.status, self.err[:7], self.err.count("\n")) == (1, "error: ", 1), self.err
        return self.err.rstrip("\n")


class Commands:
    """Runs commands in this process."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
        self._monkeypatch, self._capsys = monkeypatch, capsys

    def __call__(self, name: str, *arguments: object) -> Ended:
        self._monkeypatch.setattr(sys, "argv", [f"mua-{name}", *map(str, arguments)])
        self._capsys.readouterr()  # what was said before
        status = 0
        try:
            importlib.import_module(f"mua.cli.{name}").run()
        except SystemExit as ended:
            status = int(ended.code or 0)
        return Ended(status, *self._capsys.readouterr())


def process(name: str, *arguments: object, **environment: str) -> Ended:
    """A command in a process of its own."""
    return python(f"sys.argv[0] = 'mua-{name}'; from mua.cli.{name} import run; run()", *arguments, **environment)


def python(code: str, *arguments: object, **environment: str) -> Ended:
    """Code in a process of its own, which has `sys`."""
    line = [sys.executable, "-c", f"import sys\n{code}", *map(str, arguments)]
    ended = subprocess.run(line, capture_output=True, text=True, check=False, env={**os.environ, **environment})
    return Ended(ended.returncode, ended.stdout, ended.stderr)
