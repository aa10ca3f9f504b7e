"""A committed folder of compiled shaders: its index, what is out of date in it, and the command that renews it.

From which texts each file was made is always compared, which needs no compiler. The content is compared where this
machine has the compiler of the index, as another version of it may make other code.
"""

import argparse
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import shader_compilers

from mua.errors import InputError

INDEX = "index.json"


@dataclass(frozen=True)
class CompiledFolder:
    """A folder that the command `tool` writes."""

    tool: str  # such as gen_spirv.py
    path: Path
    ending: str
    compiler: str  # its name in shader_compilers
    sources: Callable[[], dict[str, str]]  # the digest of what each file is to be made from
    contents: Callable[[], dict[str, bytes]]  # each file, compiled now; raises InputError without the compiler

    def faults(self) -> list[str]:
        """Files that are out of date, a line each."""
        index, wanted = self.index(), self.sources()
        made_from, there = index["made from"], {path.name for path in self._files()}
        found = [f"{name} was made from another text" for name in wanted if made_from.get(name) != wanted[name]]
        found += [f"{name} is missing" for name in sorted(wanted.keys() - there)]
        found += [f"{name} belongs to no shader" for name in sorted((there | made_from.keys()) - wanted.keys())]
        if found or signature(self.compiler) != index["compiler"]:
            return found
        made = self.contents().items()
        return [
            f"{name} is not what the compiler makes"
            for name, content in made
            if (self.path / name).read_bytes() != content
        ]

    def index(self) -> dict[str, Any]:
        content: dict[str, Any] = json.loads((self.path / INDEX).read_text())
        return content

    def write(self) -> None:
        """Compile everything; raises InputError where the compiler is absent or refuses."""
        made = self.contents()
        self.path.mkdir(exist_ok=True)
        for path in self._files():
            if path.name not in made:
                path.unlink()
        for name, content in made.items():
            (self.path / name).write_bytes(content)
        about = f"written by tools/{self.tool}"
        index = {"about": about, "compiler": signature(self.compiler), "made from": self.sources()}
        (self.path / INDEX).write_text(json.dumps(index, indent=1) + "\n")

    def run(self, about: str) -> None:
        """Carry out the command line of the tool, whose docstring is `about`."""
        parser = argparse.ArgumentParser(description=about.splitlines()[0])
        parser.add_argument("--check", action="store_true", help="exit 1 where a committed file differs")
        if not parser.parse_args().check:
            try:
                self.write()
            except InputError as error:
                sys.exit(f"error: {error}")
            return
        if wrong := self.faults():
            sys.exit("\n".join([*wrong, f"{self.path} is out of date: run tools/{self.tool}"]))
        here, made_by = signature(self.compiler), self.index()["compiler"]
        if here != made_by:
            print(f"compiled code was not compared: it is of {made_by}, this machine has {here}")

    def _files(self) -> list[Path]:
        return list(self.path.glob(f"*{self.ending}"))


def signature(name: str) -> str:
    """Name and version of a compiler of this machine."""
    compiler = shader_compilers.find(name)
    return "no compiler" if compiler is None else f"{compiler.name} {compiler.version}"
