"""Write an Avatar as a `.muaavatar` file (schemas/muaavatar.fbs)."""

import struct
import zlib
from typing import get_args

import numpy as np

from mua.arguments import PathLike, as_path, describe, one_of
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.flatbuffer import VERSION, Tree, build, parse
from mua.asset.network import build_packed
from mua.asset.read import decode_tree, parse_checked
from mua.asset.rounding import rounded
from mua.asset.storable import require_storable
from mua.asset.tensors import Element, Storage, pack, pack_indices
from mua.avatar.coarser import with_levels
from mua.avatar.model import Branch, Coarse, DetailBand, Mlp
from mua.errors import InputError
from mua.files.write import write_bytes
from mua.pose.clip import Clip
from mua.pose.encoding import Components, PoseEncoding
from mua.pose.skeleton import Skeleton
from mua.rig.expressions import Expressions
from mua.rig.rig import Rig
from mua.rig.surface import Surface


def write(path: PathLike, avatar: Avatar, *, storage: Storage = "f16", rounding: float = 1.0) -> None:
    """Write `avatar` to `path`, atomically; what the reader would refuse is never written.

    `storage` is the element type of bases, static offset and MLP weights: f32, f16 or i8. Positions, means of LL and
    biases stay f32. In an i8 file bases and last layers are i8; what costs quality as i8 (docs/research/storage.md) is
    f16. "packed" is for the network: a fifth of the bytes of f16 at a loss like that of i8, unpacked when it is read;
    its numbers are rounded to steps, all of them times `rounding`.

    Errors: InputError naming the file, and the field that it cannot hold.

    Example:

        mua.save("hero_small.muaavatar", avatar, storage="i8")
    """
    path = as_path(path, "path")
    if not isinstance(avatar, Avatar):
        raise InputError(f"avatar is {describe(avatar)}; expected a mua.Avatar")
    one_of(storage, "storage", get_args(Storage))
    try:
        content = encode(avatar, storage=storage, rounding=rounding)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    write_bytes(path, content)


def encode(avatar: Avatar, *, storage: Storage = "f16", rounding: float = 1.0) -> bytes:
    """The bytes of a file; the same avatar gives the same bytes.

    Errors: InputError naming the field that a file cannot hold.
    """
    require_storable(avatar)
    avatar = with_levels(avatar)
    if storage == "packed":
        content = seal(build_packed(_avatar(rounded(avatar, rounding), "f16"), avatar.rig))
    else:
        content = seal(build(_avatar(avatar, storage)))
    decode_tree(parse_checked(content))
    return content


def seal(content: bytes) -> bytes:
    """`content` with its checksum set: CRC-32 of the whole file with the checksum's four bytes zero."""
    at = parse(content)["_at"]["crc32"]
    blank = content[:at] + bytes(4) + content[at + 4 :]
    return blank[:at] + struct.pack("<I", zlib.crc32(blank)) + blank[at + 4 :]


def _avatar(avatar: Avatar, element: Element) -> Tree:
    translated = _translated(avatar)
    return {
        "version_major": VERSION[0],
        "version_minor": VERSION[1],
        "crc32": 0,
        "axes": "MetresYUpRightHanded",
        "name": avatar.name,
        "producer": avatar.producer,
        "notes": avatar.notes,
        "skeleton": _skeleton(avatar.rig.skeleton, translated),
        "encoding": _encoding(avatar.encoding, avatar.components, element),
        "template": _template(avatar.rig),
        "texels": {
            "size": avatar.rig.texels.size,
            "texels": pack_indices(avatar.rig.texels.texels),
            "triangles": pack_indices(avatar.rig.texels.triangles),
            "barycentrics": pack(avatar.rig.texels.barycentrics[:, :2]),
            **_one_sided(avatar.rig.texels.one_sided),
            "length": avatar.rig.texels.length,
            "levels": [{"blocks": blocks} for blocks in avatar.rig.texels.levels or ()],
        },
        "wavelet": {
            "name": avatar.wavelet.name,
            "levels": avatar.wavelet.levels,
            "rec_lo": avatar.wavelet.rec_lo,
            "rec_hi": avatar.wavelet.rec_hi,
        },
        "coarse": _coarse(avatar.coarse, element),
        "geometry": _branch(avatar.geometry, element, static=_half(element)),  # i8 moves texels visibly
        "appearance": _branch(avatar.appearance, element, static=element),
        "clips": [_clip(clip, avatar.rig.skeleton, translated, element) for clip in avatar.clips],
        "bounds": pack(avatar.bounds),
        "thumbnail": np.frombuffer(avatar.thumbnail, np.uint8),
        **_surface(avatar.surface),
        **_expressions(avatar.rig.expressions, element),
    }


def _one_sided(texels: Array | None) -> Tree:
    """Absent where it was not measured."""
    return {} if texels is None else {"one_sided": np.packbits(texels, bitorder="little")}


def _surface(surface: Surface | None) -> Tree:
    """Absent where there is none."""
    return {"surface": {"runs": surface.runs, "strips": pack_indices(surface.strips)}} if surface else {}


def _expressions(expressions: Expressions | None, element: Element) -> Tree:
    """Absent where there are none."""
    if expressions is None or not len(expressions):
        return {}
    table: Tree = {
        "names": list(expressions.names),
        "starts": pack_indices(expressions.starts),
        "vertices": pack_indices(expressions.vertices),
        "offsets": pack(expressions.offsets, _half(element)),
    }
    if expressions.gains is not None and expressions.gains.any():
        table["gains"] = pack(expressions.gains, _half(element))
    if expressions.rules is not None and expressions.rules.any():
        table["rules"] = pack_indices(expressions.rules)
    return {"expressions": table}


def _translated(avatar: Avatar) -> Array:
    """Joints beside the root that a clip holds elsewhere than in the bind pose, or that the descriptor encodes."""
    skeleton = avatar.rig.skeleton
    moved = np.isin(np.arange(len(skeleton.names)), avatar.encoding.translated)
    for clip in avatar.clips:
        moved |= (np.float32(clip.translations) != np.float32(skeleton.bind_translations)).any(axis=(0, 2))
    moved[skeleton.root] = False
    return np.flatnonzero(moved)


def _skeleton(skeleton: Skeleton, translated: Array) -> Tree:
    return {
        "names": list(skeleton.names),
        "parents": pack_indices(skeleton.parents),
        "bind_rotations": pack(skeleton.bind_rotations),
        "bind_translations": pack(skeleton.bind_translations),
        "bind_inverse": pack(skeleton.bind_inverse),
        "root": skeleton.root,
        **_joints(translated),
    }


def _encoding(encoding: PoseEncoding, components: Components, element: Element) -> Tree:
    return {
        "joints": pack_indices(np.array(encoding.joints, dtype=np.int32)),
        "rotation": "SixD",
        "order": "NewestFirst",
        "window": encoding.window,
        "rate": encoding.rate,
        "heading": encoding.remove_heading,
        "mean": pack(components.normalization.mean),
        "scale": pack(components.normalization.scale),
        "components": pack(components.directions, _half(element)),
        "ranges": pack(components.ranges),
        "margins": pack(components.margins),
        **_joints(np.array(encoding.translated)),
    }


def _joints(translated: Array) -> Tree:
    """Absent where there are none."""
    return {"translated": pack_indices(translated)} if len(translated) else {}


def _template(rig: Rig) -> Tree:
    order = np.argsort(-rig.skin_weights, axis=1, kind="stable")  # largest first
    return {
        "faces": pack_indices(rig.mesh.faces),
        "uv": pack(rig.mesh.uv),
        "uv_faces": pack_indices(rig.mesh.uv_faces),
        "skin_indices": pack_indices(np.take_along_axis(rig.skin_indices, order, axis=1)),
        "skin_weights": pack(np.take_along_axis(rig.skin_weights, order, axis=1)),
    }


def _mlp(mlp: Mlp, element: Element) -> list[Tree]:
    """An error in a hidden layer reaches every coefficient, so that i8 is for the last layer, the largest, alone."""
    kinds = [*[_half(element)] * (len(mlp) - 1), element]
    layers = zip(mlp, kinds, strict=True)
    return [{"weight": pack(la.weight, kind, rows=len(la.weight)), "bias": pack(la.bias)} for la, kind in layers]


def _coarse(coarse: Coarse, element: Element) -> Tree:
    basis = pack(coarse.basis, element, rows=len(coarse.basis))
    return {"mlp": _mlp(coarse.mlp, element), "mean": pack(coarse.mean), "basis": basis}


def _branch(branch: Branch, element: Element, *, static: Element) -> Tree:
    channels, rank = branch.ll_basis.shape[:2]
    return {
        "mlp": _mlp(branch.mlp, element),
        "ll_mean": pack(branch.ll_mean),
        "ll_basis": pack(branch.ll_basis, element, rows=channels * rank),
        "details": [_detail(band, element) for band in branch.details],
        "static_offset": pack(branch.static, static, rows=channels),
    }


def _detail(band: DetailBand, element: Element) -> Tree:
    rows = int(np.prod(band.h.shape[:3]))
    return {
        "mean": pack(band.mean, _half(element)),
        "h": pack(band.h, element, rows=rows),
        "w": pack(band.w, element, rows=rows),
    }


def _clip(clip: Clip, skeleton: Skeleton, translated: Array, element: Element) -> Tree:
    tree = {
        "name": clip.name,
        "rate": clip.rate,
        "rotations": pack(clip.rotations, _half(element)),
        "translation": pack(clip.translations[:, skeleton.root]),
    }
    if len(translated):
        tree["translations"] = pack(clip.translations[:, translated])
    if clip.expressions is not None and clip.expressions.any():
        tree["expressions"] = pack(clip.expressions, _half(element))
    return tree


def _half(element: Element) -> Element:
    """i8 would cost more than it saves on tensors that are small or have no rows of like magnitude."""
    return "f16" if element == "i8" else element
