"""The JSON of a glTF file as objects of pygltflib: each field that is read is checked, absent ones are None.

pygltflib's own parser takes fields of any kind, and ten times as long for a file of many clips. The kinds that its
structures declare are those that are checked.
"""

from collections.abc import Mapping
from functools import cache
from typing import Any, TypeAlias, Union, get_args, get_origin, get_type_hints

import pygltflib

Kind: TypeAlias = "type | list[Kind]"  # a type, a structure of pygltflib, or an array of either

UNREAD = {  # fields that are not looked at
    *("asset", "cameras", "camera", "extras", "skeleton", "mimeType", "minFilter", "doubleSided", "metallicFactor"),
    *("roughnessFactor", "metallicRoughnessTexture", "normalTexture", "occlusionTexture"),
}
UNDECLARED: dict[type, dict[str, Kind]] = {
    pygltflib.Node: {"weights": [float]},
    pygltflib.Mesh: {"extras": object},
    pygltflib.Primitive: {"extras": object},
}
WORDS = {int: "a whole number", float: "a number", str: "a string", bool: "true or false", dict: "an object"}


class Names:
    """An object of the JSON whose names are free, as attributes; what it does not have is None."""

    def __init__(self, fields: Mapping[str, Any]) -> None:
        self.__dict__.update(fields)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return None


class Extensions(Names):
    """The extensions of an object: an object by each name."""


FREE: dict[type, type] = {pygltflib.Attributes: int, Extensions: dict}  # what stands by each name of such objects


def read_object(raw: Any, kind: type = pygltflib.GLTF2, where: str = "") -> Any:
    """The object `raw` as a structure of pygltflib; raises ValueError that names the field which is of another kind.

    Extensions stay dictionaries of dictionaries: whoever reads one checks what is in it.
    """
    if not isinstance(raw, dict):
        raise ValueError(f"{where} is {_short(raw)}, expected an object")
    known = dict.fromkeys(raw, FREE[kind]) if kind in FREE else _declared(kind)
    fields = {
        name: _value(raw[name], wanted, f"{where}.{name}" if where else name)
        for name, wanted in known.items()
        if raw.get(name) is not None
    }
    if kind in FREE:
        return Names(fields)
    found = kind()
    vars(found).update(dict.fromkeys(vars(found)) | dict.fromkeys(known) | fields)
    return found


@cache
def _declared(structure: type) -> Mapping[str, Kind]:
    """The kinds of the fields of a structure that are read."""
    kinds = {name: _kind(hint) for name, hint in get_type_hints(structure).items() if name not in UNREAD}
    return kinds | {"extensions": Extensions} | UNDECLARED.get(structure, {})


def _kind(hint: Any) -> Kind:
    if get_origin(hint) is Union:  # with None
        hint = get_args(hint)[0]
    return [_kind(get_args(hint)[0])] if get_origin(hint) is list else hint


def _value(raw: Any, kind: Kind, where: str) -> Any:
    if isinstance(kind, list):
        if not isinstance(raw, list):
            raise ValueError(f"{where} is {_short(raw)}, expected an array")
        return [_value(item, kind[0], f"{where}[{index}]") for index, item in enumerate(raw)]
    if kind is object:  # whoever reads the field checks what is in it
        return raw
    if kind not in WORDS:
        found = read_object(raw, kind, where)
        return vars(found) if kind is Extensions else found
    if kind is int and isinstance(raw, float) and raw.is_integer():  # some exporters write 3.0 for 3
        return int(raw)
    accepted = (int, float) if kind is float else kind
    if not isinstance(raw, accepted) or (isinstance(raw, bool) and kind is not bool):
        raise ValueError(f"{where} is {_short(raw)}, expected {WORDS[kind]}")
    return raw


def _short(raw: Any) -> str:
    text = str(raw)
    return text if len(text) <= 60 else f"{text[:57]}..."
