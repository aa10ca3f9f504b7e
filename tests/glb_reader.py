"""A .glb read by hand from the specification of glTF 2.0, for what mua writes; it shares no code with mua."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

Array = np.ndarray
TYPES = {5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class ReadGlb:
    """The JSON of a file, and its arrays."""

    def __init__(self, path: Path) -> None:
        content = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", content)
        assert (magic, version, length) == (b"glTF", 2, len(content))
        size, kind = struct.unpack_from("<I4s", content, 12)
        assert kind == b"JSON"
        self.json: dict[str, Any] = json.loads(content[20 : 20 + size])
        self._blob = content[28 + size :]

    def view(self, number: int) -> bytes:
        view = self.json["bufferViews"][number]
        start = view.get("byteOffset", 0)
        return self._blob[start : start + view["byteLength"]]

    def array(self, number: int) -> Array:
        """The values of an accessor, [count, width], or [count, 4, 4] with rows first."""
        accessor = self.json["accessors"][number]
        kind, width = np.dtype(TYPES[accessor["componentType"]]), WIDTHS[accessor["type"]]
        values = np.frombuffer(self.view(accessor["bufferView"]), kind)[: accessor["count"] * width]
        if accessor.get("normalized"):
            values = values / np.iinfo(kind).max
        return values.reshape(-1, 4, 4).swapaxes(1, 2) if width == 16 else values.reshape(-1, width)

    def attributes(self) -> dict[str, Array]:
        """The arrays of the only primitive."""
        (mesh,) = self.json["meshes"]
        (primitive,) = mesh["primitives"]
        return {name: self.array(number) for name, number in primitive["attributes"].items()}

    def faces(self) -> Array:
        return self.array(self.json["meshes"][0]["primitives"][0]["indices"]).reshape(-1, 3)

    def joint_worlds(self, frame: int | None) -> Array:
        """Matrices [J, 4, 4] of the joints to the world: at rest, or at a key of the only animation."""
        nodes = [dict(node) for node in self.json["nodes"]]
        if frame is not None:
            (animation,) = self.json["animations"]
            for channel in animation["channels"]:
                sampler = animation["samplers"][channel["sampler"]]
                nodes[channel["target"]["node"]][channel["target"]["path"]] = self.array(sampler["output"])[frame]
        worlds: dict[int, Array] = {}

        def place(number: int, above: Array) -> None:
            node = nodes[number]
            worlds[number] = above @ local(node.get("translation", (0, 0, 0)), node.get("rotation", (0, 0, 0, 1)))
            for child in node.get("children") or ():
                place(child, worlds[number])

        for root in self.json["scenes"][self.json["scene"]]["nodes"]:
            place(root, np.eye(4))
        joints = self.json["skins"][0]["joints"] if self.json.get("skins") else range(len(nodes))
        return np.array([worlds[joint] for joint in joints])

    def skinned(self, frame: int | None) -> Array:
        """The vertices [P, 3] that the joints carry to a frame."""
        found = self.attributes()
        moved = self.joint_worlds(frame) @ self.array(self.json["skins"][0]["inverseBindMatrices"])
        points = np.column_stack([found["POSITION"], np.ones(len(found["POSITION"]))])
        blend = np.einsum("pk,pkij->pij", found["WEIGHTS_0"], moved[found["JOINTS_0"]])
        return np.einsum("pij,pj->pi", blend, points)[:, :3]


def local(translation: Any, rotation: Any) -> Array:
    x, y, z, w = rotation
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = translation
    return matrix
