"""What the tools that write files of the repository have in common: they write, or --check."""

import argparse
import os
import sys
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def run(tool: str, about: str, contents: Mapping[Path, str | bytes]) -> None:
    """Carry out the command line of a tool, whose docstring is `about`, that writes these files whole."""
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="exit 1 where a committed file differs")
    check = parser.parse_args().check
    for path, content in contents.items():
        wanted = content.encode() if isinstance(content, str) else content
        if path.is_file() and path.read_bytes() == wanted:
            continue
        if check:
            sys.exit(f"{os.path.relpath(path, ROOT)} is out of date: run tools/{tool}")
        path.write_bytes(wanted)
