"""Comments beside fields and arguments, which carry shapes and units, become part of the reference.

An extension of Griffe, which reads the sources for the site (mkdocs.yml).
"""

import re
from typing import Any

import griffe

COMMENT = re.compile(r"\s#\s(.+)$")
NO_COMMENT = re.compile(r"^(noqa|type:)")


class Comments(griffe.Extension):
    """Fields get their comment as docstring; functions a list of their arguments' comments."""

    def on_attribute(self, *, attr: griffe.Attribute, **_: Any) -> None:
        comment = _comment(attr.lines[-1]) if attr.lines and attr.docstring is None else None
        if comment:
            attr.docstring = griffe.Docstring(comment, parent=attr)

    def on_function(self, *, func: griffe.Function, **_: Any) -> None:
        declared = [(_argument(line, func), _comment(line)) for line in func.lines]
        listed = "\n".join(f"- `{name}`: {comment}" for name, comment in declared if name and comment)
        if listed and func.docstring is not None:
            func.docstring.value = f"{func.docstring.value}\n\n{listed}"


def _argument(line: str, function: griffe.Function) -> str | None:
    """The argument that a line of the signature declares."""
    name = line.strip().partition(":")[0]
    return name if name in (parameter.name for parameter in function.parameters) and name != "self" else None


def _comment(line: str) -> str | None:
    found = COMMENT.search(line)
    return None if found is None or NO_COMMENT.match(found[1]) else found[1]
