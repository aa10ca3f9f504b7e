"""glTF characters, written byte by byte and read back."""

import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from mua import rotation
from mua.atlas.surfaces import Surfaces
from mua.characters.read import read_surfaces

TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
# Float32 positions of a body of 1.5 m through matrices of the file: a handful of roundings.
FLOAT_BOUND = 8 * 1.5 * 2**-23


class Glb:
    """A .glb under construction: the JSON as a dictionary, and its binary chunk."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "buffers": []}
        self.blob = b""

    def view(self, content: bytes, **fields: Any) -> int:
        self.blob += b"\0" * (-len(self.blob) % 4)
        self.json["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(content), **fields}
        )
        self.blob += content
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values: Any, dtype: str = "f4", **fields: Any) -> int:
        values = np.asarray(values).astype(np.dtype("<" + dtype))
        values = values.reshape(len(values), -1)
        fields = {"bufferView": self.view(values.tobytes()), **fields}
        self.json["accessors"].append(
            {"componentType": COMPONENTS[dtype], "count": len(values), "type": TYPES[values.shape[1]], **fields}
        )
        return len(self.json["accessors"]) - 1

    def save(self, path: Path) -> Path:
        path.write_bytes(self.content())
        return path

    def content(self) -> bytes:
        if self.blob:
            self.json["buffers"] = [{"byteLength": len(self.blob)}]
        text = json.dumps({name: value for name, value in self.json.items() if value != []}).encode()
        text += b" " * (-len(text) % 4)
        blob = self.blob + b"\0" * (-len(self.blob) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(blob), b"BIN\0") + blob
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


RINGS = 4
POINTS = np.array(
    [(x, 0.5 * r, z) for r in range(RINGS) for x, z in ((-0.2, 0.1), (0.2, 0.1), (0.2, -0.1), (-0.2, -0.1))]
)
SIDES = np.array([(4 * r + k, 4 * r + (k + 1) % 4) for r in range(RINGS - 1) for k in range(4)])
TRIANGLES = np.concatenate([np.stack([SIDES[:, 0], SIDES[:, 1], SIDES[:, 1] + 4], 1),
                            np.stack([SIDES[:, 0], SIDES[:, 1] + 4, SIDES[:, 0] + 4], 1)])  # fmt: skip
UV = np.stack([np.arange(len(POINTS)) % 4 / 4, POINTS[:, 1] / 1.5], axis=1)
BONES = np.minimum(np.arange(len(POINTS)) // 4, 2)  # one joint for each ring, the last for two
HEIGHTS = np.array([0.0, 0.5, 1.0])


def skeleton(glb: Glb, *, scale: tuple[float, float, float] = (1, 1, 1)) -> None:
    """Nodes 0..2: hips, spine and head, a chain along +Y; 3: the mesh. `scale` is that of the hips' node."""
    offsets = np.array([[0, 0, 0], [0, 0.5, 0], [0, 0.5, 0]])
    nodes = [{"name": n, "translation": o.tolist()} for n, o in zip(("hips", "spine", "head"), offsets, strict=True)]
    nodes[0] |= {"scale": list(scale), "children": [1]}
    nodes[1] |= {"children": [2], "translation": (offsets[1] / scale).tolist()}
    nodes[2]["translation"] = (offsets[2] / scale).tolist()
    glb.json["nodes"] = [*nodes, {"mesh": 0, "skin": 0, "name": "body"}]
    glb.json["scenes"] = [{"nodes": [0, 3]}]
    binds = np.tile(np.eye(4), (3, 1, 1))
    binds[:, :3, :3] = np.diag(1 / np.array(scale))
    binds[:, 1, 3] = -HEIGHTS / scale[1]
    glb.json["skins"] = [{"joints": [0, 1, 2], "inverseBindMatrices": glb.accessor(binds.swapaxes(1, 2))}]


def weighted(bones: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    joints = np.zeros((len(bones), 4), int)
    joints[:, 0] = bones
    return joints, np.eye(1, 4).repeat(len(bones), axis=0)


def body(**changes: Any) -> Glb:
    """A column on three joints with UVs and indices; `changes` replace attributes, None removes one."""
    glb = Glb()
    skeleton(glb)
    joints, weights = weighted(BONES)
    attributes = {
        "POSITION": glb.accessor(POINTS),
        "TEXCOORD_0": glb.accessor(UV),
        "JOINTS_0": glb.accessor(joints, "u1"),
        "WEIGHTS_0": glb.accessor(weights),
    } | changes
    attributes = {name: value for name, value in attributes.items() if value is not None}
    indices = glb.accessor(TRIANGLES.reshape(-1), "u2")
    glb.json["meshes"] = [{"name": "body", "primitives": [{"attributes": attributes, "indices": indices}]}]
    return glb


def primitive(glb: Glb) -> dict[str, Any]:
    return glb.json["meshes"][0]["primitives"][0]


def read(glb: Glb, tmp_path: Path) -> Surfaces:
    return read_surfaces(glb.save(tmp_path / "body.glb"))


def posed(surfaces: Surfaces, rotations: np.ndarray, translations: np.ndarray) -> np.ndarray:
    """Vertices blended linearly from rigid joints."""
    transforms = surfaces.skeleton.skinning(rotations, translations)
    return sum(
        surfaces.skin_weights[:, k, None]
        * rotation.dual_transform(transforms[surfaces.skin_indices[:, k]], surfaces.vertices)
        for k in range(8)
    )


def assert_is_column(surfaces: Surfaces, bound: float = FLOAT_BOUND) -> None:
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], POINTS[TRIANGLES], atol=bound)
    np.testing.assert_array_equal(surfaces.skin_indices[surfaces.faces][..., 0], BONES[TRIANGLES])
    np.testing.assert_allclose(surfaces.uv[surfaces.uv_faces], UV[TRIANGLES], atol=bound)
    bind = surfaces.skeleton.bind_pose
    np.testing.assert_allclose(posed(surfaces, bind.rotations, bind.translations), surfaces.vertices, atol=1e-7)


def accessor_of(glb: Glb, name: str) -> dict[str, Any]:
    return glb.json["accessors"][primitive(glb)["attributes"][name]]


def meshopt_view(
    glb: Glb, encoded: bytes, *, count: int, stride: int, mode: str, name: str = "EXT_meshopt_compression"
) -> int:
    properties = {"buffer": 0, "byteOffset": len(glb.blob) + -len(glb.blob) % 4, "byteLength": len(encoded)}
    glb.view(encoded)
    plain = {"buffer": 1, "byteLength": count * stride}  # the fallback buffer, which holds no bytes
    extension = {name: properties | {"count": count, "byteStride": stride, "mode": mode}}
    glb.json["bufferViews"].append(plain | ({"byteStride": stride} if mode == "ATTRIBUTES" else {}))
    glb.json["bufferViews"][-1]["extensions"] = extension
    return len(glb.json["bufferViews"]) - 1


def textured(picture: np.ndarray, *, kind: str = "png", **material: Any) -> Glb:
    glb = body()
    content = io.BytesIO()
    Image.fromarray(picture).save(content, kind, lossless=True)
    glb.json["images"] = [{"bufferView": glb.view(content.getvalue()), "mimeType": f"image/{kind}"}]
    glb.json["textures"] = [{"source": 0, "sampler": 0}]
    glb.json["samplers"] = [{"wrapS": 33071, "wrapT": 33648}]
    model = {"baseColorTexture": {"index": 0}} | material.pop("model", {})
    glb.json["materials"] = [{"name": "cloth", "pbrMetallicRoughness": model, **material}]
    primitive(glb)["material"] = 0
    return glb


PICTURE = np.arange(2 * 3 * 4, dtype=np.uint8).reshape(2, 3, 4) * 10


def animate(
    glb: Glb, node: int, path: str, *, times: Any, values: Any, kind: str = "LINEAR", name: str = "wave"
) -> None:
    animations = glb.json.setdefault("animations", [])
    if not animations or animations[-1]["name"] != name:
        animations.append({"name": name, "channels": [], "samplers": []})
    sampler = {"input": glb.accessor(times), "output": glb.accessor(values), "interpolation": kind}
    animations[-1]["samplers"].append(sampler)
    target = {"node": node, "path": path}
    animations[-1]["channels"].append({"sampler": len(animations[-1]["samplers"]) - 1, "target": target})


HALF_TURN = [[0, 0, 0, 1], [0, 0, 1, 0]]  # xyzw, about +Z
