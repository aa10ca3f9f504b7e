"""Ways to spoil a `.muaavatar`, and the code and field that every reader must answer with.

MALFORMED edits the tree of a sound file before it is built and sealed again, DAMAGED its bytes.
"""

import struct
import zlib
from collections.abc import Callable
from typing import Any

import numpy as np

from mua.asset.flatbuffer import FormatError, Tree, build, parse
from mua.asset.tensors import pack, pack_indices
from mua.asset.write import seal


def malformed(content: bytes, edit: Callable[[Tree], None]) -> bytes:
    """A sound file after `edit`, sealed."""
    tree = parse(content)
    tree.pop("stages", None)  # of a file that ends elsewhere
    edit(tree)
    return seal_unread(build(tree))


def seal_unread(content: bytes) -> bytes:
    """Seal a file that the parser may refuse."""
    try:
        return seal(content)
    except (FormatError, KeyError):  # or one without a checksum
        return content


def child(tree: Tree, path: str) -> tuple[Any, Any]:
    """The container of the last part of a dotted path, and that part."""
    parts: list[Any] = [int(p) if p.isdigit() else p for p in path.split(".")]
    for part in parts[:-1]:
        tree = tree[part]
    return tree, parts[-1]


def put(path: str, value: Any) -> Callable[[Tree], None]:
    def edit(tree: Tree) -> None:
        container, last = child(tree, path)
        container[last] = value

    return edit


def times(path: str, factor: float) -> Callable[[Tree], None]:
    """Multiply all elements of an f32 tensor."""

    def edit(tree: Tree) -> None:
        container, last = child(tree, path)
        values = container[last]["data"].view("<f4") * np.float32(factor)
        container[last] = {**container[last], "data": values.view(np.uint8)}

    return edit


def long_filters(tree: Tree) -> None:
    """One pair of taps more than there may be."""
    tree["wavelet"]["rec_lo"] = tree["wavelet"]["rec_hi"] = np.full(42, 0.1)


def poke(path: str, at: int, value: float) -> Callable[[Tree], None]:
    """Change one element of an f32, f16 or i32 tensor."""

    def edit(tree: Tree) -> None:
        container, last = child(tree, path)
        tensor = container[last]
        dtype = {"F32": "<f4", "F16": "<f2", "I32": "<i4"}[tensor["type"]]
        values = tensor["data"].view(dtype).copy()
        values[at] = value
        container[last] = {**tensor, "data": values.view(np.uint8)}

    return edit


def fewer_components(tree: Tree) -> None:
    """One component less than the first layers read."""
    own = tree["encoding"]
    own["components"] = pack(np.zeros((19, 84)))
    own["ranges"], own["margins"] = pack(np.zeros((2, 19))), pack(np.zeros(19))


def drop(path: str) -> Callable[[Tree], None]:
    def edit(tree: Tree) -> None:
        container, last = child(tree, path)
        del container[last]

    return edit


def grow_texture(tree: Tree) -> None:
    """A side that halves three times, where the wavelet has four levels."""
    tree["texels"]["size"] += 8


def negative_weight(tree: Tree) -> None:
    """The rows still sum to 1."""
    weights = tree["template"]["skin_weights"]["data"].view("<f4").copy().reshape(-1, 8)
    weights[3] = [1.25, 0, 0, 0, 0, 0, 0, -0.25]
    tree["template"]["skin_weights"] = pack(weights)


def smaller_weight_first(tree: Tree) -> None:
    weights = tree["template"]["skin_weights"]["data"].view("<f4").copy().reshape(-1, 8)
    weights[3, :2] = weights[3, 1::-1]
    tree["template"]["skin_weights"] = pack(weights)


def endless(tree: Tree) -> None:
    """A few frames that are too many at the rate of the encoding."""
    clip = tree["clips"][0]
    frames = 1049  # a thousand times as many are more than 2^20
    tree["encoding"]["rate"], clip["rate"] = 1000.0, 1.0
    for name, width in (("rotations", 12), ("translation", 3), ("translations", 3)):
        values = clip[name]["data"].view({"F32": "<f4", "F16": "<f2"}[clip[name]["type"]]).reshape(-1, width)
        shape = [frames, *clip[name]["shape"][1:]]
        clip[name] = pack(np.repeat(values[:1], frames, axis=0).reshape(shape), "f16")


def manifold(tree: Tree) -> None:
    """Each clip has few enough frames, all of them together gain too many joints at the rate of the encoding."""
    clip, joints = tree["clips"][0], 3
    tree["encoding"]["rate"], clip["rate"] = 1000.0, 1.0
    gained = (1000 - 1) * len(clip["rotations"]["data"]) // (joints * 4 * 2) * joints
    tree["clips"] = [clip] * ((1 << 24) // gained + 1)


def not_a_number(at: int) -> Callable[[Tree], None]:
    """An odd number of halves, one of them NaN."""

    def edit(tree: Tree) -> None:
        values = np.zeros((7, 3))
        values.ravel()[at] = 1
        tensor = pack(values, "f16")
        tensor["data"] = np.where(tensor["data"].view("<u2") > 0, 0x7E00, 0).astype("<u2").view(np.uint8)
        tree["clips"][0]["translation"] = tensor

    return edit


def empty(*shape: int) -> Tree:
    """A tensor without elements whose other sides may be anything."""
    return {**pack(np.zeros((0, 1))), "shape": np.array(shape, np.uint32)}


NAN = float("nan")
MALFORMED = [
    ("version", "version_major", put("version_major", 6)),
    ("version", "version_major", put("version_major", 4)),
    ("missing", "skeleton", drop("skeleton")),
    ("missing", "geometry.mlp", drop("geometry.mlp")),
    ("value", "skeleton.parents", poke("skeleton.parents", 1, 2)),
    ("range", "skeleton.parents", poke("skeleton.parents", 1, 9)),
    ("value", "skeleton.root", put("skeleton.root", 3)),
    ("value", "skeleton.bind_rotations", poke("skeleton.bind_rotations", 0, 2)),
    ("value", "skeleton.bind_rotations", times("skeleton.bind_rotations", 1.005)),
    ("shape", "skeleton.bind_rotations.shape", put("skeleton.bind_rotations", pack(np.full((1, 3, 4), 0.5)))),
    ("finite", "skeleton.bind_translations", poke("skeleton.bind_translations", 0, NAN)),
    ("value", "skeleton.bind_inverse", poke("skeleton.bind_inverse", 5, 0.5)),
    ("value", "skeleton.bind_inverse", times("skeleton.bind_inverse", 1.001)),
    ("shape", "skeleton.bind_inverse.shape", put("skeleton.bind_inverse", pack(np.zeros((3, 7))))),
    ("value", "encoding.joints", poke("encoding.joints", 0, 0)),
    ("value", "encoding.joints", poke("encoding.joints", 1, 1)),
    ("value", "skeleton.bind_translations", poke("skeleton.bind_translations", 0, 65536)),
    ("value", "skeleton.bind_inverse", poke("skeleton.bind_inverse", 23, -65536)),
    ("range", "encoding.joints", poke("encoding.joints", 0, 7)),
    ("range", "skeleton.translated", poke("skeleton.translated", 0, 3)),
    ("range", "skeleton.translated", poke("skeleton.translated", 0, -1)),
    ("value", "skeleton.translated", poke("skeleton.translated", 0, 0)),
    ("value", "skeleton.translated", put("skeleton.translated", pack_indices(np.array([2, 2])))),
    ("value", "skeleton.translated", put("skeleton.translated", pack_indices(np.array([2, 1])))),
    ("shape", "skeleton.translated.shape", put("skeleton.translated", pack_indices(np.array([[2]])))),
    ("type", "skeleton.translated", put("skeleton.translated", pack(np.array([2.0])))),
    ("range", "encoding.translated", poke("encoding.translated", 0, 3)),
    ("value", "encoding.translated", poke("encoding.translated", 0, 0)),
    ("value", "encoding.translated", poke("encoding.translated", 0, 1)),
    ("value", "encoding.translated", drop("skeleton.translated")),
    ("shape", "encoding.scale.shape", drop("encoding.translated")),
    ("value", "encoding.window", put("encoding.window", 0)),
    ("value", "encoding.window", put("encoding.window", 17)),
    ("shape", "encoding.scale.shape", put("encoding.window", 2)),
    *[("value", "encoding.rate", put("encoding.rate", rate)) for rate in (NAN, 0, -30, 0.99, 1001, float("inf"))],
    *[("value", "encoding.scale", poke("encoding.scale", at, scale)) for at, scale in ((0, 0), (5, -1), (9, 9e-7))],
    ("value", "encoding.scale", poke("encoding.scale", 3, 65536)),
    ("finite", "encoding.mean", poke("encoding.mean", 0, NAN)),
    ("missing", "encoding.components", drop("encoding.components")),
    ("missing", "encoding.margins", drop("encoding.margins")),
    ("shape", "encoding.components.shape", put("encoding.components", pack(np.zeros((20, 71))))),
    ("shape", "coarse.mlp[0].weight.shape", fewer_components),
    ("shape", "geometry.mlp[0].weight.shape", put("geometry.mlp.0.weight", pack(np.zeros((16, 19))))),
    ("shape", "appearance.mlp[0].weight.shape", put("appearance.mlp.0.weight", pack(np.zeros((16, 21))))),
    ("finite", "encoding.components", poke("encoding.components", 7, NAN)),
    ("shape", "encoding.ranges.shape", put("encoding.ranges", pack(np.zeros((2, 19))))),
    ("shape", "encoding.ranges.shape", put("encoding.ranges", pack(np.zeros((20, 2))))),
    ("value", "encoding.ranges", poke("encoding.ranges", 4, 100)),
    ("finite", "encoding.ranges", poke("encoding.ranges", 23, float("inf"))),
    ("shape", "encoding.margins.shape", put("encoding.margins", pack(np.zeros(21)))),
    ("value", "encoding.margins", poke("encoding.margins", 19, -1e-3)),
    ("finite", "encoding.margins", poke("encoding.margins", 3, NAN)),
    ("range", "template.faces", poke("template.faces", 0, 12)),
    ("range", "template.faces", poke("template.faces", 0, -1)),
    ("range", "template.uv_faces", poke("template.uv_faces", 2, 99)),
    ("range", "template.skin_indices", poke("template.skin_indices", 0, 3)),
    ("value", "template.skin_weights", poke("template.skin_weights", 0, 5)),
    ("value", "template.skin_weights", times("template.skin_weights", 1.001)),
    ("value", "template.skin_weights", negative_weight),
    ("value", "template.skin_weights", smaller_weight_first),
    ("type", "template.faces", put("template.faces", pack(np.zeros((18, 3))))),
    ("type", "template.uv", put("template.uv", pack_indices(np.zeros((16, 2))))),
    ("value", "texels.size", put("texels.size", 0)),
    ("value", "texels.size", put("texels.size", 4097)),
    ("shape", "geometry.ll_basis.shape", put("texels.size", 64)),
    ("value", "texels.texels", poke("texels.texels", 0, 900)),
    ("range", "texels.texels", poke("texels.texels", 0, 1024)),
    ("range", "texels.triangles", poke("texels.triangles", 0, 18)),
    ("value", "texels.barycentrics", poke("texels.barycentrics", 0, 1.5)),
    *[("shape", "texels.one_sided", put("texels.one_sided", np.zeros(n, np.uint8))) for n in (0, 84, 86)],
    ("value", "wavelet.levels", put("wavelet.levels", 99)),
    ("value", "wavelet.rec_lo", put("wavelet.rec_lo", np.zeros(3))),
    ("value", "wavelet.rec_lo", long_filters),
    ("finite", "wavelet.rec_lo", put("wavelet.rec_lo", np.full(10, NAN))),
    ("finite", "wavelet.rec_lo", put("wavelet.rec_hi", np.full(10, NAN))),
    ("value", "wavelet.rec_lo", put("wavelet.rec_lo", np.full(10, -16.1))),
    ("value", "wavelet.rec_lo", put("wavelet.rec_hi", np.full(10, 16.1))),
    ("finite", "coarse.mean", poke("coarse.mean", 3, float("inf"))),
    ("shape", "coarse.basis.shape", put("coarse.basis", pack(np.zeros((4, 11, 3))))),
    ("shape", "coarse.mlp", put("coarse.mlp", [])),
    ("shape", "coarse.mlp[0].weight.shape", put("coarse.mlp.0.weight", pack(np.zeros((16, 5))))),
    ("shape", "geometry.mlp", drop("geometry.mlp.2")),
    ("value", "texels.size", grow_texture),
    ("finite", "geometry.ll_mean", poke("geometry.ll_mean", 0, NAN)),
    ("finite", "geometry.details[0].mean", poke("geometry.details.0.mean", 0, NAN)),
    ("shape", "geometry.static_offset.shape", put("geometry.static_offset", pack(np.zeros((11, 3))))),
    ("shape", "appearance.ll_basis.shape", put("appearance.ll_basis", pack(np.zeros((11, 4, 2, 2))))),
    ("shape", "geometry.ll_basis.scale", put("geometry.ll_basis.scale", np.ones(7))),
    ("shape", "geometry.ll_basis.data", put("geometry.ll_basis.data", np.zeros(5, np.uint8))),
    ("shape", "geometry.ll_basis.shape", put("geometry.ll_basis.shape", np.ones(9, np.uint32))),
    ("finite", "geometry.ll_basis", put("geometry.ll_basis.scale", np.full(44, NAN))),
    ("value", "clips[0].rotations", poke("clips.0.rotations", 0, 9)),
    ("value", "clips[0].rotations", put("clips.0.rotations", empty(0, 3, 4))),
    ("shape", "clips[0].rotations.shape", put("clips.0.rotations", pack(np.full((3, 4), 0.5)))),
    ("shape", "clips[0].rotations.shape", put("clips.0.rotations", empty(0, *[2**32 - 1] * 3))),
    ("shape", "clips[0].translation.shape", put("clips.0.translation", pack(np.zeros((3, 3))))),
    ("missing", "clips[0].translations", drop("clips.0.translations")),
    ("shape", "clips[0].translations.shape", put("clips.0.translations", pack(np.zeros((7, 2, 3))))),
    ("shape", "clips[0].translations.shape", put("clips.0.translations", pack(np.zeros((6, 1, 3))))),
    ("finite", "clips[0].translations", poke("clips.0.translations", 0, NAN)),
    *[("value", "clips[0].rate", put("clips.0.rate", rate)) for rate in (NAN, 0, 1e-30, 0.99, 1001)],
    ("value", "clips[0].rotations", endless),
    ("value", "clips[799].rotations", manifold),
    ("value", "geometry.ll_basis", put("geometry.ll_basis.scale", np.full(44, 600.0))),
    ("value", "geometry.ll_basis", put("geometry.ll_basis.scale", np.full(44, -600.0))),
    *[("finite", "coarse.mean", poke("coarse.mean", -1 - k, NAN)) for k in range(3)],
    ("finite", "skeleton.bind_translations", poke("skeleton.bind_translations", 8, NAN)),  # 4 bytes after whole words
    *[("finite", "clips[0].translation", not_a_number(at)) for at in (17, 20)],  # the last is 2 bytes after whole words
    ("value", "encoding.mean", poke("encoding.mean", 71, -65536)),
    ("value", "bounds", poke("bounds", 0, 5)),
    ("missing", "surface.strips", drop("surface.strips")),
    ("shape", "surface.runs", put("surface.runs", np.zeros(0, np.uint8))),
    ("shape", "surface.runs", put("surface.runs", np.full(1000, 0xF0, np.uint8))),
    ("value", "surface.runs", poke("texels.texels", 0, 0)),  # a block has lost a corner
    ("shape", "surface.strips.shape", put("surface.strips", pack_indices(np.zeros((4, 3))))),
    ("type", "surface.strips", put("surface.strips", pack(np.zeros(4)))),
    ("range", "surface.strips", poke("surface.strips", 0, -2)),
    ("range", "surface.strips", poke("surface.strips", 0, 2 * 676)),
    ("value", "thumbnail", put("thumbnail", np.frombuffer(b"GIF89a", np.uint8))),
]


def stream(planes: bytes) -> np.ndarray:
    deflate = zlib.compressobj(9, zlib.DEFLATED, -15)
    return np.frombuffer(deflate.compress(planes) + deflate.flush(), np.uint8)


def claim(path: str, shape: tuple[int, ...], planes: bytes) -> Callable[[Tree], None]:
    """A packed tensor of a shape that its stream need not fill."""
    return put(path, {"shape": np.array(shape, np.uint32), "type": "I32", "data": stream(planes), "packing": "Deflate"})


def nothing_of_a_damaged_stream(tree: Tree) -> None:
    """A tensor without elements, whose stream is damaged before it gives any."""
    claim("skeleton.translated", (0,), b"")(tree)
    tree["skeleton"]["translated"]["data"] = np.full(50, 0xFF, np.uint8)


def claims_together(tree: Tree) -> None:
    """Each of two tensors claims less than a file of its size may give, both claim more."""
    for path in ("texels.texels", "texels.triangles"):
        claim(path, (1 << 18,), b"")(tree)


def listed(*texels: int) -> Callable[[Tree], None]:
    """The barycentrics of some texels alone are stored."""

    def edit(tree: Tree) -> None:
        tree["texels"]["listed"] = pack_indices(np.array(texels))
        tree["texels"]["barycentrics"] = pack(np.full((len(texels), 2), 0.25))

    return edit


def without_area(tree: Tree) -> None:
    """All texture coordinates are one."""
    tree["template"]["uv"] = pack(np.full(tree["template"]["uv"]["shape"], 0.5))


TEXELS = 676  # of the synthetic avatar
UNPACKABLE = [  # of a file for the network
    ("packed", "texels.texels.data", put("texels.texels.data", np.full(50, 0xFF, np.uint8))),
    ("packed", "texels.texels.data", put("texels.texels.data", np.zeros(0, np.uint8))),
    ("packed", "texels.texels.data", put("texels.texels.data", stream(bytes(4 * TEXELS))[:-1])),
    ("packed", "texels.texels.data", claim("texels.texels", (TEXELS,), bytes(4 * TEXELS - 1))),
    ("packed", "texels.texels.data", claim("texels.texels", (TEXELS,), bytes(4 * TEXELS + 1))),
    ("value", "encoding.translated", claim("skeleton.translated", (0,), bytes(1))),
    ("value", "encoding.translated", nothing_of_a_damaged_stream),
    ("value", "texels.texels.data", claim("texels.texels", (1 << 24,), bytes(1 << 26))),
    ("value", "surface.strips.data", claim("surface.strips", (1 << 16, 1 << 14), b"")),
    ("value", "texels.triangles.data", claims_together),
    ("shape", "texels.texels.shape", claim("texels.texels", (1 << 16, 1 << 16), b"")),
    ("shape", "texels.texels.shape", claim("texels.texels", (), b"")),
    ("shape", "texels.texels.shape", claim("texels.texels", (TEXELS, 1), bytes(4 * TEXELS))),
    ("value", "texels.texels", claim("texels.texels", (TEXELS,), bytes(4 * TEXELS))),
    ("type", "coarse.mean", claim("coarse.mean", (12, 3), bytes(4 * 36))),
    ("range", "texels.listed", listed(TEXELS)),
    ("range", "texels.listed", listed(-1)),
    ("value", "texels.listed", listed(3, 3)),
    ("value", "texels.listed", listed(4, 3)),
    ("type", "texels.listed", put("texels.listed", pack(np.zeros(2)))),
    ("shape", "texels.barycentrics.shape", put("texels.barycentrics", pack(np.zeros((TEXELS, 2))))),
    ("shape", "texels.barycentrics.shape", drop("texels.listed")),
    ("value", "texels.listed", without_area),
    ("value", "stages", put("stages", np.array([8, 7]))),
    ("value", "stages", put("stages", np.array([1 << 30]))),
    ("shape", "appearance.mlp", drop("appearance.details.1")),  # a level is missing
]


def patch(at: int, form: str, value: int, content: bytes) -> bytes:
    return content[:at] + struct.pack(form, value) + content[at + struct.calcsize(form) :]


def pointed(content: bytes, at: int) -> int:
    """Where the offset at byte `at` points to."""
    return at + int(struct.unpack_from("<I", content, at)[0])


def root(content: bytes, field: str) -> int:
    """The byte at which a field of the root table stands."""
    return int(parse(content)["_at"][field])


def newer(content: bytes) -> bytes:
    """A file of a later major version, of which the rest cannot be read."""
    kept = patch(root(content, "version_major"), "<H", 9, content)[: len(content) // 2]
    return kept + bytes(len(content) - len(kept))


def without_checksum(content: bytes) -> bytes:
    start = pointed(content, 0)
    vtable = start - struct.unpack_from("<i", content, start)[0]
    return patch(vtable + 4 + 2 * 2, "<H", 0, content)  # crc32 is slot 2


def twice(content: bytes) -> bytes:
    """Appearance is geometry, which is larger: tables and vectors claim more bytes than there are."""
    at = root(content, "appearance")
    return patch(at, "<I", pointed(content, root(content, "geometry")) - at, content)


DAMAGED: list[tuple[str, str, Callable[[bytes], bytes]]] = [
    ("truncated", "", lambda content: b""),
    ("truncated", "", lambda content: content[:7]),
    ("identifier", "", lambda content: patch(4, "<I", 0, content)),
    ("truncated", "", lambda content: patch(0, "<I", 2**32 - 4, content)),
    ("offset", "", lambda content: patch(0, "<I", pointed(content, 0) + 1, content)),
    ("offset", "", lambda content: patch(pointed(content, 0), "<i", 1, content)),
    ("truncated", "", lambda content: patch(pointed(content, 0), "<i", -(2**31), content)),
    ("version", "version_major", newer),
    ("missing", "crc32", without_checksum),
    ("checksum", "crc32", lambda content: patch(root(content, "crc32"), "<I", 0, content)),
    ("checksum", "crc32", lambda content: content + b"\0"),
    ("enum", "axes", lambda content: patch(root(content, "axes"), "<B", 1, content)),
    ("offset", "name", lambda content: patch(root(content, "name"), "<I", 1, content)),
    ("truncated", "notes", lambda content: patch(root(content, "notes"), "<I", 2**31, content)),
    ("truncated", "name", lambda content: patch(pointed(content, root(content, "name")), "<I", 2**32 - 1, content)),
    ("truncated", "clips", lambda content: patch(pointed(content, root(content, "clips")), "<I", 2**31, content)),
    ("text", "name", lambda content: patch(pointed(content, root(content, "name")) + 4, "<B", 0xFF, content)),
    ("text", "name", lambda content: patch(pointed(content, root(content, "name")) + 4, "<I", 0x80A0ED, content)),
    ("text", "name", lambda content: patch(pointed(content, root(content, "name")) + 4, "<H", 0x80C0, content)),
    ("offset", "appearance.static_offset.data", twice),
]
