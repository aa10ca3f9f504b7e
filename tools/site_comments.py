"""Comments beside fields and arguments, and the help of options, become part of the reference.

An extension of Griffe, which reads the sources for the site (mkdocs.yml).
"""

import ast
import re
from typing import Any

import griffe

SHARED = "mua.baking.shared_options."  # names for options of several functions
COMMENT = re.compile(r"\s#\s(.+)$")
NO_COMMENT = re.compile(r"^(noqa|type:)")


class Comments(griffe.Extension):
    """Fields get their comment as docstring; functions a list of their arguments' comments and help."""

    def on_attribute(self, *, attr: griffe.Attribute, **_: Any) -> None:
        comment = _comment(attr.lines[-1]) if attr.lines and attr.docstring is None else None
        if comment:
            attr.docstring = griffe.Docstring(comment, parent=attr)

    def on_function(self, *, func: griffe.Function, loader: griffe.GriffeLoader, **_: Any) -> None:
        declared = [(_argument(line, func), _comment(line)) for line in func.lines]
        declared += [(parameter.name, _plain(parameter, loader)) for parameter in func.parameters]
        listed = "\n".join(f"- `{name}`: {comment}" for name, comment in declared if name and comment)
        if listed and func.docstring is not None:
            func.docstring.value = f"{func.docstring.value}\n\n{listed}"


def _argument(line: str, function: griffe.Function) -> str | None:
    """The argument that a line of the signature declares."""
    name = line.strip().partition(":")[0]
    return name if name in (parameter.name for parameter in function.parameters) and name != "self" else None


def _plain(parameter: griffe.Parameter, loader: griffe.GriffeLoader) -> str | None:
    """Leave of `Annotated[type, Option(help)]`, or a name for it, the type; returns the help."""
    annotation = parameter.annotation
    if isinstance(annotation, griffe.ExprName) and annotation.canonical_path.startswith(SHARED):
        annotation = loader.modules_collection[annotation.canonical_path].value
    if not isinstance(annotation, griffe.ExprSubscript) or str(annotation.left) != "Annotated":
        return None
    assert isinstance(annotation.slice, griffe.ExprTuple)
    kind, option = annotation.slice.elements
    if not isinstance(option, griffe.ExprCall) or str(option.function) != "Option":
        return None
    parameter.annotation = kind
    return str(ast.literal_eval(str(option.arguments[0])))


def _comment(line: str) -> str | None:
    found = COMMENT.search(line)
    return None if found is None or NO_COMMENT.match(found[1]) else found[1]
