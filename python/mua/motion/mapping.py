"""Mapping files: which joint of a motion moves which joint of a character, written down by a person."""

import json
import tomllib
from collections.abc import Sequence
from pathlib import Path

from mua.errors import InputError
from mua.files.write import write_bytes
from mua.motion.match import JointPair


def read_mapping(path: Path) -> dict[str, str]:
    """Read a mapping file, `{"target_joint": "source_joint"}` as JSON or TOML, by suffix.

    A target joint of an empty source is one that nothing was found for and is left out.
    Errors: InputError if it cannot be read, parsed, or holds anything but strings.
    """
    parse = tomllib.loads if path.suffix.lower() == ".toml" else json.loads
    try:
        mapping = parse(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as a mapping of joint names: {error}") from error
    if not isinstance(mapping, dict):
        raise InputError(f"{path}: expected a table from target to source joint names, found {type(mapping).__name__}")
    for target, source in mapping.items():
        if not isinstance(source, str):
            raise InputError(f"{path}: {target}: expected the name of a source joint, found {source!r}")
    return {target: source for target, source in mapping.items() if source}


def write_mapping(path: Path, pairs: Sequence[JointPair], unmatched: Sequence[str] = ()) -> None:
    """Write a mapping file to start from: what was matched, and the `unmatched` target joints with an empty source."""
    mapping = {pair.target: pair.source for pair in pairs} | dict.fromkeys(unmatched, "")
    if path.suffix.lower() == ".toml":
        text = "".join(f"{_quoted(target)} = {_quoted(source)}\n" for target, source in mapping.items())
    else:
        text = json.dumps(mapping, indent=2, ensure_ascii=False) + "\n"
    write_bytes(path, text.encode())


def _quoted(name: str) -> str:
    return json.dumps(name, ensure_ascii=False)  # the escapes of a JSON string are those of a TOML string
