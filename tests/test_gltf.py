"""glTF characters, written byte by byte and read back."""

import base64
import io
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import DracoPy
import meshoptimizer
import numpy as np
import pytest
import trimesh
from PIL import Image
from scipy.spatial import cKDTree

from mua import rotation
from mua.errors import InputError
from mua.rig.assemble import Surfaces
from mua.rig.gltf_animation import sample
from mua.rig.read import read_surfaces

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


def posed(surfaces: Surfaces, rotations: np.ndarray, translation: np.ndarray) -> np.ndarray:
    """Vertices blended linearly from rigid joints."""
    transforms = surfaces.skeleton.skinning(rotations, translation)
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
    np.testing.assert_allclose(posed(surfaces, bind.rotations, bind.translation), surfaces.vertices, atol=1e-7)


def test_reads_positions_weights_and_texture_coordinates(tmp_path: Path) -> None:
    surfaces = read(body(), tmp_path)
    assert_is_column(surfaces)
    assert surfaces.skeleton.names == ("hips", "spine", "head")
    assert surfaces.skeleton.names[surfaces.skeleton.root] == "hips"
    np.testing.assert_allclose(surfaces.skeleton.bind_translations[:, 1], [0, 0.5, 0.5], atol=FLOAT_BOUND)
    assert not surfaces.notes


def test_reads_json_with_buffer_beside_it(tmp_path: Path) -> None:
    glb = body()
    glb.json["buffers"] = [{"byteLength": len(glb.blob), "uri": "the%20buffer.bin"}]
    (tmp_path / "the buffer.bin").write_bytes(glb.blob)
    (tmp_path / "body.gltf").write_text(json.dumps(glb.json))
    assert_is_column(read_surfaces(tmp_path / "body.gltf"))


def test_reads_buffer_in_a_data_uri(tmp_path: Path) -> None:
    glb = body()
    uri = "data:application/octet-stream;base64," + base64.b64encode(glb.blob).decode()
    glb.json["buffers"] = [{"byteLength": len(glb.blob), "uri": uri}]
    (tmp_path / "body.gltf").write_text(json.dumps(glb.json))
    assert_is_column(read_surfaces(tmp_path / "body.gltf"))


def test_welds_unindexed_triangles(tmp_path: Path) -> None:
    glb = body()
    corners = TRIANGLES.reshape(-1)
    joints, weights = weighted(BONES[corners])
    primitive(glb)["attributes"] = {
        "POSITION": glb.accessor(POINTS[corners]),
        "TEXCOORD_0": glb.accessor(UV[corners]),
        "JOINTS_0": glb.accessor(joints, "u2"),
        "WEIGHTS_0": glb.accessor(weights),
    }
    del primitive(glb)["indices"]
    surfaces = read(glb, tmp_path)
    assert len(surfaces.vertices) == len(POINTS)
    assert_is_column(surfaces)


def test_merges_primitives_and_materials(tmp_path: Path) -> None:
    glb = body()
    whole = primitive(glb)
    halves = [whole | {"indices": glb.accessor(t.reshape(-1), "u4"), "material": m}
              for m, t in ((1, TRIANGLES[:12]), (0, TRIANGLES[12:]))]  # fmt: skip
    glb.json["meshes"][0]["primitives"] = halves
    glb.json["materials"] = [
        {"name": "skin", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.2140411, 0, 0.5]}},
        {"name": "veil", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}},
    ]
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    assert len(surfaces.vertices) == len(POINTS)  # the border between the halves is one row of vertices
    names = [surfaces.materials[m].name for m in surfaces.face_material]
    assert names == ["veil"] * 12 + ["skin"] * 12
    colors = {m.name: m.image[0, 0].tolist() for m in surfaces.materials}
    assert colors == {"skin": [255, 127, 0, 255], "veil": [255, 255, 255, 128]}


@pytest.mark.parametrize("mode", [5, 6])
def test_reads_strips_and_fans(tmp_path: Path, mode: int) -> None:
    glb = body()
    indices = [0, 1, 4, 5, 8] if mode == 5 else [0, 1, 5, 4]
    primitive(glb).update(mode=mode, indices=glb.accessor(np.array(indices), "u1"))
    expected = [[0, 1, 4], [1, 5, 4], [4, 5, 8]] if mode == 5 else [[1, 5, 0], [5, 4, 0]]
    surfaces = read(glb, tmp_path)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], POINTS[np.array(expected)], atol=FLOAT_BOUND)


def test_folds_unequal_scales_of_joints_into_the_mesh(tmp_path: Path) -> None:
    glb = body()
    glb.json["skins"], glb.json["nodes"] = [], []
    skeleton(glb, scale=(0.01, 0.02, 0.04))
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    np.testing.assert_allclose(surfaces.skeleton.bind_translations[:, 1], [0, 0.5, 0.5], atol=FLOAT_BOUND)


def test_folds_a_scale_that_the_rest_pose_adds(tmp_path: Path) -> None:
    glb = body()
    glb.json["nodes"][2]["scale"] = [2, 1, 1]  # the head is made twice as wide after binding
    surfaces = read(glb, tmp_path)
    head = surfaces.skin_indices[:, 0] == 2
    assert np.ptp(surfaces.vertices[head, 0]) == pytest.approx(0.8, abs=1e-6)
    assert np.ptp(surfaces.vertices[~head, 0]) == pytest.approx(0.4, abs=1e-6)


def test_reads_quantised_attributes(tmp_path: Path) -> None:
    glb = body()
    steps = 30000 / 1.5
    binds = np.tile(np.eye(4), (3, 1, 1))
    binds[:, :3, :3] *= 1.5 * 32767 / 30000
    binds[:, 1, 3] = -HEIGHTS
    joints, weights = weighted(BONES)
    attributes = {
        "POSITION": glb.accessor(np.pad(np.round(POINTS * steps), ((0, 0), (0, 1))), "i2"),
        "TEXCOORD_0": glb.accessor(np.round(UV * 65535), "u2", normalized=True),
        "JOINTS_0": glb.accessor(joints, "u1"),
        "WEIGHTS_0": glb.accessor(weights * 255, "u1", normalized=True),
    }
    glb.json["accessors"][attributes["POSITION"]] |= {"type": "VEC3", "normalized": True}
    glb.json["bufferViews"][glb.json["accessors"][attributes["POSITION"]]["bufferView"]]["byteStride"] = 8
    glb.json["skins"][0]["inverseBindMatrices"] = glb.accessor(binds.swapaxes(1, 2))
    primitive(glb)["attributes"] = attributes
    glb.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    assert_is_column(read(glb, tmp_path), bound=1 / steps)


def meshopt_view(glb: Glb, encoded: bytes, *, count: int, stride: int, mode: str) -> int:
    properties = {"buffer": 0, "byteOffset": len(glb.blob) + -len(glb.blob) % 4, "byteLength": len(encoded)}
    glb.view(encoded)
    plain = {"buffer": 1, "byteLength": count * stride}  # the fallback buffer, which holds no bytes
    extension = {"EXT_meshopt_compression": properties | {"count": count, "byteStride": stride, "mode": mode}}
    glb.json["bufferViews"].append(plain | ({"byteStride": stride} if mode == "ATTRIBUTES" else {}))
    glb.json["bufferViews"][-1]["extensions"] = extension
    return len(glb.json["bufferViews"]) - 1


@pytest.mark.parametrize("index", ["u2", "u4"])
def test_reads_meshopt_compression(tmp_path: Path, index: str) -> None:
    glb = body()
    floats = POINTS.astype("<f4")
    encoded = meshoptimizer.encode_vertex_buffer(floats, len(floats), 12)
    position = glb.accessor(POINTS)
    glb.json["accessors"][position]["bufferView"] = meshopt_view(
        glb, bytes(encoded), count=len(POINTS), stride=12, mode="ATTRIBUTES"
    )
    corners = TRIANGLES.reshape(-1).astype(np.uint32)
    encoded = meshoptimizer.encode_index_buffer(corners, len(corners), len(POINTS))
    indices = glb.accessor(corners, index)
    glb.json["accessors"][indices]["bufferView"] = meshopt_view(
        glb, bytes(encoded), count=len(corners), stride=int(index[1]), mode="TRIANGLES"
    )
    primitive(glb)["attributes"]["POSITION"] = position
    primitive(glb)["indices"] = indices
    glb.json["extensionsRequired"] = ["EXT_meshopt_compression"]
    surfaces = read(glb, tmp_path)
    corner_sets = {frozenset(map(tuple, np.round(t, 5))) for t in surfaces.vertices[surfaces.faces]}
    assert corner_sets == {frozenset(map(tuple, np.round(t, 5))) for t in POINTS[TRIANGLES]}


def test_reads_draco_compression(tmp_path: Path) -> None:
    bits = 16
    glb = body()
    joints, weights = weighted(BONES)
    encoded = DracoPy.encode(
        POINTS.astype(np.float32),
        TRIANGLES.astype(np.uint32),
        quantization_bits=bits,
        preserve_order=True,
        tex_coord=UV,
        generic_attributes={5: joints.astype(np.uint8), 6: weights.astype(np.float32)},
    )
    ids = {a["attribute_type"]: a["unique_id"] for a in DracoPy.decode(encoded).attributes if a["attribute_type"] != 4}
    attributes = {"POSITION": ids[0], "TEXCOORD_0": ids[3], "JOINTS_0": 5, "WEIGHTS_0": 6}
    extension = {"bufferView": glb.view(encoded), "attributes": attributes}
    primitive(glb)["extensions"] = {"KHR_draco_mesh_compression": extension}
    for accessor in (*primitive(glb)["attributes"].values(), primitive(glb)["indices"]):
        del glb.json["accessors"][accessor]["bufferView"]
    glb.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    assert_is_column(read(glb, tmp_path), bound=1.5 / 2**bits)


def test_reads_sparse_accessors(tmp_path: Path) -> None:
    glb = body()
    moved = np.array([3, 7])
    base = POINTS.copy()
    base[moved] = 0
    position = glb.accessor(base)
    glb.json["accessors"][position]["sparse"] = {
        "count": 2,
        "indices": {"bufferView": glb.view(moved.astype("<u2").tobytes()), "componentType": 5123},
        "values": {"bufferView": glb.view(POINTS[moved].astype("<f4").tobytes())},
    }
    primitive(glb)["attributes"]["POSITION"] = position
    assert_is_column(read(glb, tmp_path))


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


def test_opaque_texture_has_full_opacity(tmp_path: Path) -> None:
    (material,) = read(textured(PICTURE), tmp_path).materials
    np.testing.assert_array_equal(material.image[..., :3], PICTURE[..., :3])
    assert (material.image[..., 3] == 255).all()
    assert (material.wrap_u, material.wrap_v) == ("clamp", "mirror")


def test_masked_texture_keeps_its_alpha_times_the_factor(tmp_path: Path) -> None:
    model = {"baseColorFactor": [1, 1, 1, 0.5]}
    (material,) = read(textured(PICTURE, alphaMode="MASK", model=model), tmp_path).materials
    np.testing.assert_array_equal(material.image[..., 3], np.round(PICTURE[..., 3] * 0.5))


def test_factor_is_multiplied_in_linear_light(tmp_path: Path) -> None:
    picture = np.full((1, 1, 4), 188, np.uint8)  # sRGB 188 is half of the light of 255
    model = {"baseColorFactor": [0.5, 1, 0, 1]}
    (material,) = read(textured(picture, model=model), tmp_path).materials
    np.testing.assert_allclose(material.image[0, 0, :3], [137, 188, 0], atol=1)


def test_reads_webp_textures(tmp_path: Path) -> None:
    glb = textured(PICTURE, kind="webp", alphaMode="BLEND")
    glb.json["textures"] = [{"extensions": {"EXT_texture_webp": {"source": 0}}}]
    glb.json["extensionsRequired"] = ["EXT_texture_webp"]
    (material,) = read(glb, tmp_path).materials
    visible = PICTURE[..., 3] > 0
    np.testing.assert_array_equal(material.image[visible], PICTURE[visible])


def test_reads_texture_beside_the_file(tmp_path: Path) -> None:
    glb = textured(PICTURE)
    Image.fromarray(PICTURE).save(tmp_path / "cloth.png")
    glb.json["images"] = [{"uri": "cloth.png"}]
    assert read(glb, tmp_path).materials[0].image.shape == PICTURE.shape


def test_texture_transform_scales_turns_and_moves(tmp_path: Path) -> None:
    glb = textured(PICTURE)
    transform = {"offset": [0.1, 0.2], "rotation": np.pi / 2, "scale": [2, 3]}
    info = {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": transform | {"texCoord": 0}}}
    glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = info
    glb.json["extensionsRequired"] = ["KHR_texture_transform"]
    surfaces = read(glb, tmp_path)
    u, v = np.moveaxis(UV[TRIANGLES], -1, 0)
    # a quarter turn counter-clockwise with v down takes +u to -v and +v to +u
    np.testing.assert_allclose(surfaces.uv[surfaces.uv_faces], np.stack([3 * v + 0.1, -2 * u + 0.2], -1), atol=1e-6)


def test_second_set_of_influences_counts(tmp_path: Path) -> None:
    glb = body()
    _, weights = weighted(BONES)
    more = np.zeros((len(BONES), 4))
    more[:, 0] = 1
    primitive(glb)["attributes"] |= {
        "WEIGHTS_0": glb.accessor(weights * 0.25),
        "JOINTS_1": glb.accessor(np.full((len(BONES), 4), 2), "u1"),
        "WEIGHTS_1": glb.accessor(more * 0.75),
    }
    surfaces = read(glb, tmp_path)
    assert (surfaces.skin_indices[:, 0] == 2).all()
    np.testing.assert_allclose(np.unique(surfaces.skin_weights[:, 0]), [0.75, 1])


def test_mesh_on_a_joint_follows_it_rigidly(tmp_path: Path) -> None:
    glb = body()
    hat = {"attributes": {"POSITION": glb.accessor([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]])}}
    glb.json["meshes"].append({"name": "hat", "primitives": [hat]})
    glb.json["nodes"].append({"mesh": 1, "translation": [0, 0.6, 0]})
    glb.json["nodes"][2]["children"] = [4]
    surfaces = read(glb, tmp_path)
    (hat_face,) = np.flatnonzero((surfaces.uv_faces == -1).all(axis=1))
    worn = surfaces.vertices[surfaces.faces[hat_face]]
    np.testing.assert_allclose(worn, [[0, 1.6, 0], [0.1, 1.6, 0], [0, 1.7, 0]], atol=FLOAT_BOUND)
    assert (surfaces.skin_indices[surfaces.faces[hat_face], 0] == 2).all()
    assert surfaces.notes == ("Mesh hat has no texture coordinates.",)


def test_mesh_on_no_joint_is_left_out_with_a_note(tmp_path: Path) -> None:
    glb = body()
    glb.json["nodes"].append({"mesh": 0, "name": "ground"})
    glb.json["scenes"][0]["nodes"].append(4)
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    assert surfaces.notes == ("Mesh ground hangs on no joint and is left out.",)


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


def test_clip_turns_and_moves_the_joints(tmp_path: Path) -> None:
    glb = body()
    animate(glb, 1, "rotation", times=[0.0, 1.0], values=HALF_TURN)
    animate(glb, 0, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [3, 0, 0]])
    (clip,) = read(glb, tmp_path).clips
    assert (clip.name, clip.rate, len(clip)) == ("wave", 30.0, 31)
    np.testing.assert_allclose(clip.translation[15], [1.5, 0, 0], atol=FLOAT_BOUND)
    np.testing.assert_allclose(clip.rotations[15, 1], [np.sqrt(0.5), 0, 0, np.sqrt(0.5)], atol=1e-7)
    np.testing.assert_allclose(clip.rotations[:, 2], np.tile([1, 0, 0, 0], (31, 1)), atol=1e-7)


def test_clip_of_no_length_is_dropped_with_a_note(tmp_path: Path) -> None:
    glb = body()
    animate(glb, 1, "rotation", times=[0.0], values=HALF_TURN[:1], name="pose")
    surfaces = read(glb, tmp_path)
    assert not surfaces.clips
    assert surfaces.notes == ("Clip pose has no length and is left out.",)


def test_motion_above_the_skeleton_moves_its_root(tmp_path: Path) -> None:
    glb = body()
    glb.json["nodes"].append({"name": "armature", "children": [0]})
    glb.json["scenes"][0]["nodes"] = [3, 4]
    animate(glb, 4, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [0, 0, 2]])
    animate(glb, 0, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [1, 0, 0]])
    surfaces = read(glb, tmp_path)
    positions = surfaces.skeleton.world(surfaces.clips[0].rotations, surfaces.clips[0].translation)[1]
    hips = surfaces.skeleton.names.index("hips")
    np.testing.assert_allclose(positions[-1, hips], [1, 0, 2], atol=FLOAT_BOUND)
    assert surfaces.skeleton.root == hips


def test_dropped_translation_and_scale_are_told(tmp_path: Path) -> None:
    glb = body()
    animate(glb, 0, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [1, 0, 0]])
    animate(glb, 2, "translation", times=[0.0, 1.0], values=[[0, 0.5, 0], [0, 0.51, 0]])
    animate(glb, 2, "scale", times=[0.0, 1.0], values=[[1, 1, 1], [1.5, 1, 1]])
    assert read(glb, tmp_path).notes == (
        "Translations of joints other than hips are dropped; the largest is 10 mm, of head in clip wave.",
        "Animated scales are dropped; the largest is 50 %, of head in clip wave.",
    )


def test_step_holds_and_cubic_passes_its_keys() -> None:
    times, keys = np.array([0.0, 1.0, 3.0]), np.array([[0.0], [1.0], [5.0]])
    at = np.array([-1, 0, 0.99, 1, 2.5, 3, 9])
    np.testing.assert_array_equal(sample(times, keys, at, kind="STEP", spherical=False)[:, 0], [0, 0, 0, 1, 1, 5, 5])
    slopes = np.gradient(times**2, times, edge_order=2)  # a parabola, which cubic segments hold exactly
    cubic = np.stack([slopes, times**2, slopes], axis=1).reshape(-1, 1)
    inside = np.linspace(0, 3, 13)
    values = sample(times, cubic, inside, kind="CUBICSPLINE", spherical=False)[:, 0]
    np.testing.assert_allclose(values, inside**2, atol=1e-12)


def test_positions_equal_those_of_a_second_reader(shared_data: Any) -> None:
    path = shared_data.path("characters/Fox.glb")
    scene = trimesh.load(path, process=False)
    theirs = scene.to_geometry().vertices * 0.01
    ours = read_surfaces(path).vertices
    for here, there in ((ours, theirs), (theirs, ours)):
        assert cKDTree(here).query(there)[0].max() < FLOAT_BOUND


def test_woman_stands_in_metres_and_faces_forward(shared_data: Any) -> None:
    surfaces = read_surfaces(shared_data.path("characters/White_F_3_Casual.glb"))
    assert len(surfaces.skeleton.names) == 84
    assert surfaces.skeleton.names[surfaces.skeleton.root] == "Hips"
    low, high = surfaces.vertices.min(axis=0), surfaces.vertices.max(axis=0)
    assert abs(low[1]) < 0.01
    assert 1.5 < high[1] < 1.8
    assert 1.5 < high[0] - low[0] < 1.8  # arms spread
    places = dict(zip(surfaces.skeleton.names, surfaces.skeleton.world(
        surfaces.skeleton.bind_rotations, surfaces.skeleton.bind_pose.translation)[1], strict=True))  # fmt: skip
    assert places["LeftHand"][0] > 0.5 > -0.5 > places["RightHand"][0]
    assert places["LeftToeBase"][2] > places["LeftFoot"][2] + 0.05
    assert [m.name for m in surfaces.materials] == ["_Body", "Hair"]
    bind = surfaces.skeleton.bind_pose
    np.testing.assert_allclose(posed(surfaces, bind.rotations, bind.translation), surfaces.vertices, atol=1e-6)


def test_lumberjack_stands_upright_and_keeps_its_clips(shared_data: Any) -> None:
    surfaces = read_surfaces(shared_data.path("characters/lumberjack.glb"))
    assert abs(surfaces.vertices[:, 1].min()) < 0.01
    assert surfaces.vertices[:, 1].max() == pytest.approx(1.7026, abs=1e-3)  # 170.26 centimetres in the file
    assert [(clip.name, len(clip)) for clip in surfaces.clips] == [("Walk", 31), ("Poses", 188)]
    assert surfaces.notes[0] == "Clip A-pose has no length and is left out."
    skeleton = surfaces.skeleton
    assert len(skeleton.names) == 33  # of 53: the others carry no weights and have no bind pose
    assert skeleton.names[skeleton.root] == "DEF-spine_02"
    parents = {n: skeleton.names[p] for n, p in zip(skeleton.names, skeleton.parents, strict=True) if p >= 0}
    assert parents["DEF-thigh.L_023"] == parents["DEF-thigh.R_015"] == "DEF-spine_02"
    assert parents["DEF-upper_arm.L_045"] == "DEF-spine.003_05"
    clip = surfaces.clips[0]
    feet = min(posed(surfaces, r, t)[:, 1].min() for r, t in zip(clip.rotations, clip.translation, strict=True))
    assert abs(feet) < 0.03


def test_fox_is_brought_to_metres(shared_data: Any) -> None:
    surfaces = read_surfaces(shared_data.path("characters/Fox.glb"))
    assert np.ptp(surfaces.vertices, axis=0) == pytest.approx([0.2519, 0.7903, 1.5472], abs=1e-3)
    assert [(clip.name, len(clip)) for clip in surfaces.clips] == [("Survey", 103), ("Walk", 22), ("Run", 35)]
    assert "one unit is taken as 0.01 m" in surfaces.notes[0]


def accessor_of(glb: Glb, name: str) -> dict[str, Any]:
    return glb.json["accessors"][primitive(glb)["attributes"][name]]


def put(name: str, values: Any, dtype: str = "f4") -> Callable[[Glb], None]:
    return lambda glb: primitive(glb)["attributes"].__setitem__(name, glb.accessor(values, dtype))


NAN = np.where(np.arange(len(POINTS))[:, None] == 5, np.nan, POINTS)
BROKEN: dict[str, tuple[Callable[[Glb], Any], str]] = {
    "unknown extension": (lambda g: g.json.update(extensionsRequired=["KHR_texture_basisu"]), "KHR_texture_basisu"),
    "old version": (lambda g: g.json.update(asset={"version": "1.0"}), r"asset\.version is 1\.0"),
    "accessor outside": (lambda g: accessor_of(g, "POSITION").update(count=999), "accessors.*reaches to byte"),
    "accessor missing": (lambda g: primitive(g)["attributes"].update(POSITION=99), r"attributes\.POSITION is 99"),
    "accessor type": (lambda g: accessor_of(g, "TEXCOORD_0").update(type="SCALAR"), r"type is SCALAR, expected VEC2"),
    "component type": (lambda g: accessor_of(g, "POSITION").update(componentType=7), "componentType is 7"),
    "no count": (lambda g: accessor_of(g, "POSITION").update(count=0), "count is 0"),
    "view outside": (lambda g: g.json["bufferViews"][0].update(byteLength=10**6), r"bufferViews\[0\] spans"),
    "buffer missing": (lambda g: g.json["bufferViews"][0].update(buffer=3), r"bufferViews\[0\]\.buffer is 3"),
    "not finite": (put("POSITION", NAN), r"nan.* at element 5"),
    "index outside": (lambda g: primitive(g).update(indices=g.accessor([0, 1, 99], "u1")), "indices holds 99"),
    "no position": (lambda g: primitive(g)["attributes"].pop("POSITION"), "no POSITION"),
    "fewer weights": (put("WEIGHTS_0", [[1, 0, 0, 0]]), "WEIGHTS_0 holds 1 elements for 16"),
    "no weights": (lambda g: primitive(g)["attributes"].pop("WEIGHTS_0"), "lacks JOINTS_0 with WEIGHTS_0"),
    "missing joint": (put("JOINTS_0", np.full((16, 4), 7), "u1"), "holds 7, but the skin has 3 joints"),
    "negative weight": (put("WEIGHTS_0", np.full((16, 4), -0.5)), "no negative weight"),
    "joint node": (lambda g: g.json["skins"][0].update(joints=[0, 1, 20]), r"skins\[0\]\.joints is 20"),
    "few binds": (lambda g: g.json["skins"][0].update(joints=[0, 1, 2, 3]), "holds 3 matrices for 4 joints"),
    "singular bind": (
        lambda g: g.json["skins"][0].update(inverseBindMatrices=g.accessor(np.zeros((3, 16)))),
        "cannot be inverted",
    ),
    "no skin": (lambda g: [g.json["nodes"][3].pop("skin"), g.json.pop("skins")], "no skinned mesh"),
    "skin missing": (lambda g: g.json["nodes"][3].update(skin=4), r"nodes\[3\]\.skin is 4"),
    "mesh missing": (lambda g: g.json["nodes"][3].update(mesh=4), r"nodes\[3\]\.mesh is 4"),
    "material missing": (lambda g: primitive(g).update(material=4), r"material is 4"),
    "node cycle": (lambda g: g.json["nodes"][2].update(children=[0]), "its own ancestor"),
    "two parents": (lambda g: g.json["nodes"][0].update(children=[1, 2]), "child of both"),
    "bad matrix": (lambda g: g.json["nodes"][0].update(matrix=[1, 2]), r"nodes\[0\]\.matrix"),
    "bad sampler": (
        lambda g: animate(g, 1, "rotation", times=[0.0, 1.0], values=HALF_TURN[:1]),
        "holds 1 elements, expected 2",
    ),
    "times fall": (lambda g: animate(g, 1, "rotation", times=[1.0, 0.0], values=HALF_TURN), "do not increase"),
    "wrong kind": (lambda g: g.json.update(nodes=7), "wrong kind"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_file_ends_in_one_sentence(tmp_path: Path, name: str) -> None:
    glb = body()
    breaks, sentence = BROKEN[name]
    breaks(glb)
    with pytest.raises(InputError, match=sentence) as raised:
        read(glb, tmp_path)
    assert str(raised.value).startswith(str(tmp_path / "body.glb"))


def test_texture_that_is_no_image_is_named(tmp_path: Path) -> None:
    glb = textured(PICTURE)
    glb.json["images"][0]["bufferView"] = 0
    with pytest.raises(InputError, match=r"images\[0\] is not a PNG"):
        read(glb, tmp_path)


def test_broken_compression_is_named(tmp_path: Path) -> None:
    glb = body()
    primitive(glb)["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
    with pytest.raises(InputError, match="KHR_draco_mesh_compression cannot be decoded"):
        read(glb, tmp_path)
    glb = body()
    view = meshopt_view(glb, b"\xa0garbage", count=16, stride=12, mode="ATTRIBUTES")
    accessor_of(glb, "POSITION")["bufferView"] = view
    with pytest.raises(InputError, match="EXT_meshopt_compression cannot be decoded"):
        read(glb, tmp_path)


def test_truncation_anywhere_is_refused(tmp_path: Path) -> None:
    content = body().content()
    path = tmp_path / "body.glb"
    for length in range(len(content)):
        path.write_bytes(content[:length])
        with pytest.raises(InputError, match=r"body\.glb"):
            read_surfaces(path)


def test_bad_json_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "body.gltf"
    for text in (b"", b"{", b"[]", b"7", b'{"asset": 3}', b"\xff\xfe", b'{"asset": {"version": "2.0"}, "meshes": [3]}'):
        path.write_bytes(text)
        with pytest.raises(InputError, match=r"body\.gltf"):
            read_surfaces(path)


def test_unknown_suffix_and_missing_file_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"suffix is \.fbx, expected one of \.glb"):
        read_surfaces(tmp_path / "body.fbx")
    with pytest.raises(InputError, match="no such file"):
        read_surfaces(tmp_path / "body.glb")
