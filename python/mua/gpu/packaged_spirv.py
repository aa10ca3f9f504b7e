"""The SPIR-V that comes with the package, so that only those who change shaders need a compiler.

`tools/gen_spirv.py` writes the folder: a file for each entry point, and an index that says what each was made from.
"""

import hashlib
import json
from collections.abc import Iterable
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).with_name("spirv")
INDEX = "index.json"


def find(path: Path, options: tuple[str, ...], made_from: str) -> bytes | None:
    """The code of an entry point if it was made from what has this digest; `options` begin with (entry, stage)."""
    name = file_name(path, *options[:2])
    return (FOLDER / name).read_bytes() if index().get(name) == made_from else None


def file_name(path: Path, entry: str, stage: str) -> str:
    return f"{path.stem}.{entry}.{stage}.spv"


def digest(texts: Iterable[str], options: tuple[str, ...]) -> str:
    """A digest of an entry point's sources: the texts of shader and includes, entry, stage and defines."""
    found = hashlib.sha256()
    for part in (*options, *texts):
        found.update(len(part).to_bytes(8, "little") + part.encode())
    return found.hexdigest()


@cache
def index() -> dict[str, str]:
    """The digest of each file of the folder."""
    entries: dict[str, str] = json.loads((FOLDER / INDEX).read_text())["made from"]
    return entries
