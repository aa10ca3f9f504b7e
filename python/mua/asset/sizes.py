"""Counts of parts and the size of the texture, which a few bytes could claim: checked before any tensor is opened."""

from mua.asset.flatbuffer import FormatError, Tree
from mua.channels import most_levels
from mua.limits import (
    MAX_CLIPS,
    MAX_EXPRESSIONS,
    MAX_JOINTS,
    MAX_LAYERS,
    MAX_LEVELS,
    MAX_SIDE,
    TEXTURE_ROOM,
    TEXTURE_TIMES,
)


def require_sizes(tree: Tree) -> None:
    """Raises FormatError with code `value` for the first part that is too large for a sound file."""
    levels, details = tree["wavelet"]["levels"], [len(tree[name]["details"]) for name in ("geometry", "appearance")]
    _require("skeleton.names", len(tree["skeleton"]["names"]), MAX_JOINTS)
    _require("wavelet.levels", levels, MAX_LEVELS, least=1)
    _require_texture(tree["texels"], levels)
    for name in ("coarse", "geometry", "appearance"):
        _require(f"{name}.mlp", len(tree[name]["mlp"]), MAX_LAYERS)
    _require("geometry.details", details[0], levels)
    _require("appearance.details", details[1], levels)
    most = most_levels(levels, max(details), taps=tree["wavelet"]["rec_lo"].size)
    _require("texels.levels", len(tree["texels"]["levels"]), most)
    _require("clips", len(tree["clips"]), MAX_CLIPS)
    if "expressions" in tree:
        _require("expressions.names", len(tree["expressions"]["names"]), MAX_EXPRESSIONS)


def _require_texture(texels: Tree, levels: int) -> None:
    """Its memory goes with its sides, which a few bytes could claim: so many must be valid."""
    side, shape = texels["size"], texels["texels"]["shape"]
    count = int(shape[0]) if len(shape) else 0
    _require("texels.size", side, MAX_SIDE, least=1)
    if side % (1 << levels):
        raise FormatError("value", "texels.size", f"{side} does not halve {levels} times")
    if side * side > TEXTURE_TIMES * count + TEXTURE_ROOM:
        raise FormatError("value", "texels.size", f"{side}, too large for {count} valid texels")


def _require(field: str, number: int, most: int, *, least: int = 0) -> None:
    if not least <= number <= most:
        raise FormatError("value", field, f"{number}, expected {least} to {most}")
