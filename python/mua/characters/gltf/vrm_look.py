"""How a VRM's gaze turns the joints of its eyes: lookAt of VRM 1.0, firstPerson of VRM 0."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.gltf.document import Document

EYES = ("leftEye", "rightEye")
_WAYS = {"Out": "HorizontalOuter", "In": "HorizontalInner", "Up": "VerticalUp", "Down": "VerticalDown"}
_DEGREES = 10.0  # where the file does not say, as UniVRM writes it
_MOST = 90.0


def eye_reach(document: Document, vrm: dict[str, Any], where: str, *, first: bool) -> Mapping[str, float]:
    """Degrees that the whole range of a gaze turns the eyes, by way; none where the file turns no joints by it.

    `first`: the file is of VRM 0, whose curves are taken as straight lines.
    """
    part = "firstPerson" if first else "lookAt"
    stated = vrm.get(part) or {}
    if not isinstance(stated, dict):
        raise document.error(f"{where}.{part} is {stated}, expected an object")
    if stated.get("lookAtTypeName" if first else "type") not in ("Bone", "bone"):
        return {}
    found: dict[str, float] = {}
    for way, name in _WAYS.items():
        field = f"{'lookAt' if first else 'rangeMap'}{name}"
        table = stated.get(field) or {}
        if not isinstance(table, dict):
            raise document.error(f"{where}.{part}.{field} is {table}, expected an object")
        key = "yRange" if first else "outputScale"
        degrees = table.get(key, _DEGREES)
        if type(degrees) not in (int, float) or not 0 <= degrees <= _MOST:
            raise document.error(f"{where}.{part}.{field}.{key} is {degrees}, expected 0 to {_MOST:g} degrees")
        found[way] = float(degrees)
    return found


def look_node(document: Document, animation: dict[str, Any], where: str) -> int | None:
    """The node of a VRM animation whose rotation is where it looks, if it looks anywhere."""
    stated = animation.get("lookAt") or {}
    if not isinstance(stated, dict):
        raise document.error(f"{where}.lookAt is {stated}, expected an object")
    node: Any = stated.get("node")
    if node is None:
        return None
    document.item("nodes", node, field=f"{where}.lookAt.node")
    return int(node)


def gaze_weights(
    rotations: Array,  # [K, 4] wxyz
) -> dict[str, Array]:
    """The weights [K] of VRM's gaze that looks where +Z is turned: 1 at 90 degrees, the whole range of its presets."""
    ahead = rotation.rotate(rotation.normalize(rotations), np.array([0.0, 0, 1]))
    left = np.degrees(np.arctan2(ahead[:, 0], ahead[:, 2])) / _MOST
    down = np.degrees(np.arcsin(np.clip(-ahead[:, 1], -1, 1))) / _MOST
    shares = {"lookLeft": left, "lookRight": -left, "lookDown": down, "lookUp": -down}
    return {name: np.clip(share, 0, 1) for name, share in shares.items()}
