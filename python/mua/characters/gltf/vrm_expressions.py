"""The expressions of a VRM avatar, of either version: which morph targets each of them moves, and how far."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from mua.characters.gltf.document import Document
from mua.characters.messages import Messages

_COLOURS = "Colours and textures that an expression changes stay as they are: {}."
_HOLDING = {"blink": "overrideBlink", "look": "overrideLookAt", "mouth": "overrideMouth"}


@dataclass(frozen=True)
class VrmExpression:
    """An expression by its name in the file, with the morph targets that weight 1 of it moves."""

    name: str
    binds: Sequence[tuple[int, int, float]]  # node (VRM 1) or mesh (VRM 0), target, weight
    by_mesh: bool
    switched: bool = False  # whether it shows wholly above 0.5, else not at all
    overrides: Mapping[str, str] = field(default_factory=dict)  # "blink", "look" or "mouth" to "block" or "blend"

    def weights_of(self, node: int, mesh: int) -> Mapping[int, float]:
        """The weight of each target of a mesh on a node; those it does not name are 0."""
        weights: dict[int, float] = {}
        for holder, target, weight in self.binds:
            if holder == (mesh if self.by_mesh else node):
                weights[target] = weights.get(target, 0.0) + weight
        return weights


def read_expressions(
    document: Document, vrm: dict[str, Any], where: str
) -> tuple[tuple[VrmExpression, ...], tuple[str, ...]]:
    """The expressions of a VRM extension, presets first, and what of them is not carried, a sentence each."""
    messages = Messages()
    read = _groups if "blendShapeMaster" in vrm else _tables
    found: dict[str, VrmExpression] = {}
    for name, entry, at in read(document, vrm, where):
        expression = _expression(document, name, entry, at, messages)
        if name in found:
            messages.add("Of expressions of one name the first is taken: {}.", name)
        else:
            found[name] = expression
    return tuple(found.values()), messages.notes()


def animated_expressions(document: Document, animation: dict[str, Any], where: str) -> dict[int, str]:
    """The expression of each node of a VRM animation whose x is the weight of one."""
    found: dict[int, str] = {}
    for name, entry, at in _tables(document, animation, where):
        document.item("nodes", entry.get("node"), field=f"{at}.node")
        found[int(entry["node"])] = name
    return found


def _groups(document: Document, vrm: dict[str, Any], where: str) -> list[tuple[str, dict[str, Any], str]]:
    """VRM 0: a list of groups, each a preset or one with a name of its own."""
    where = f"{where}.blendShapeMaster"
    master = _object(document, vrm["blendShapeMaster"], where)
    groups = _array(document, master.get("blendShapeGroups"), f"{where}.blendShapeGroups")
    found = []
    for g, group in enumerate(groups):
        at = f"{where}.blendShapeGroups[{g}]"
        entry = _object(document, group, at)
        preset = entry.get("presetName")
        name = preset if isinstance(preset, str) and preset.lower() not in ("", "unknown") else entry.get("name")
        found.append((str(name or f"expression {g}"), entry, at))
    return found


def _tables(document: Document, vrm: dict[str, Any], where: str) -> list[tuple[str, dict[str, Any], str]]:
    """VRM 1: a table of presets and one of others."""
    where = f"{where}.expressions"
    expressions = _object(document, vrm.get("expressions") or {}, where)
    found = []
    for kind in ("preset", "custom"):
        for name, entry in _object(document, expressions.get(kind) or {}, f"{where}.{kind}").items():
            at = f"{where}.{kind}.{name}"
            found.append((str(name), _object(document, entry, at), at))
    return found


def _expression(document: Document, name: str, entry: dict[str, Any], at: str, messages: Messages) -> VrmExpression:
    by_mesh = "morphTargetBinds" not in entry and "binds" in entry
    field = "binds" if by_mesh else "morphTargetBinds"
    binds = []
    for b, stated in enumerate(_array(document, entry.get(field), f"{at}.{field}")):
        place = f"{at}.{field}[{b}]"
        bind = _object(document, stated, place)
        holder: Any = bind.get("mesh" if by_mesh else "node")
        document.item("meshes" if by_mesh else "nodes", holder, field=f"{place}.{'mesh' if by_mesh else 'node'}")
        binds.append((int(holder), *_target(document, bind, place, whole=100 if by_mesh else 1)))
    if any(entry.get(field) for field in ("materialColorBinds", "textureTransformBinds", "materialValues")):
        messages.add(_COLOURS, name)
    switched = bool(entry.get("isBinary"))
    overrides = {kind: how for kind, key in _HOLDING.items() if (how := entry.get(key, "none")) != "none"}
    for kind, how in overrides.items():
        if how not in ("block", "blend"):
            raise document.error(f"{at}.{_HOLDING[kind]} is {how}, expected none, block or blend")
    return VrmExpression(name, tuple(binds), by_mesh, switched, overrides)


def _target(document: Document, bind: dict[str, Any], place: str, *, whole: float) -> tuple[int, float]:
    """The target's number and its weight, of which `whole` is all."""
    index, weight = bind.get("index"), bind.get("weight", whole)
    if type(index) is not int or index < 0:
        raise document.error(f"{place}.index is {index}, expected the number of a morph target")
    if type(weight) not in (int, float) or not abs(weight) < 1e6:
        raise document.error(f"{place}.weight is {weight}, expected a number from 0 to {whole:g}")
    return index, weight / whole


def _object(document: Document, value: Any, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise document.error(f"{where} is {value}, expected an object")
    return value


def _array(document: Document, value: Any, where: str) -> list[Any]:
    if value is not None and not isinstance(value, list):
        raise document.error(f"{where} is {value}, expected an array")
    return value or []
