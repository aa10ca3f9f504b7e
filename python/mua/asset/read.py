"""Read a `.muaavatar` file: every shape relation, range and finiteness is checked before an Avatar leaves here."""

import zlib

import numpy as np

from mua.arguments import PathLike, as_path
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.flatbuffer import AGAIN, FormatError, Tree, parse, refuse
from mua.asset.magnitude import require_bounded
from mua.asset.packing import unpack
from mua.asset.read_model import read_branch, read_coarse, read_wavelet
from mua.asset.read_rig import read_rig, read_skeleton, read_surface, read_translated, with_expressions
from mua.asset.sizes import require_sizes
from mua.asset.tensors import indices, reals, some_reals, unit_quaternions
from mua.errors import InputError
from mua.files.inputs import require_file
from mua.limits import LARGEST_RATE, LEAST_RATE, LEAST_SCALE, MAX_ADDED, MAX_FRAMES, MAX_WINDOW, STAGES
from mua.pose.clip import Clip
from mua.pose.encoding import Components, Normalization, PoseEncoding
from mua.pose.skeleton import Skeleton

GEOMETRY_CHANNELS, APPEARANCE_CHANNELS = 11, 12
PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def read(path: PathLike) -> Avatar:
    """The avatar in the `.muaavatar` file at `path`; stored f16 and i8 are expanded to float32.

    Errors: InputError with one sentence that names the file, the field and what is wrong with it.

    Example:

        avatar = mua.load("hero.muaavatar")
    """
    try:
        return decode_tree(load(path))
    except FormatError as error:
        raise error.inside(str(path)) from error


def load(path: PathLike) -> Tree:
    """The file at `path` as a tree whose bytes and checksum are sound; tensors stay in their stored type.

    Errors: InputError naming the file and field.
    """
    path = as_path(path, "path")
    require_file(path)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from error
    try:
        return parse_checked(content)
    except FormatError as error:
        raise error.inside(str(path)) from error


def parse_checked(content: bytes) -> Tree:
    """The tree of a file whose structure and checksum are sound; packed tensors are unpacked.

    Errors: FormatError, with code `checksum` where the content is not what was written.
    """
    tree = parse(content)
    at = tree["_at"].get("crc32")
    if at is None:
        raise FormatError("missing", "crc32", "the field is required and absent")
    found = zlib.crc32(content[at + 4 :], zlib.crc32(bytes(4), zlib.crc32(content[:at])))
    if found != tree["crc32"]:
        raise FormatError(
            "checksum", "crc32", f"{tree['crc32']:08x}, but the content gives {found:08x}: the file is damaged; {AGAIN}"
        )
    _require_stages(tree, len(content))
    require_sizes(tree)
    unpack(tree, len(content))
    return tree


def _require_stages(tree: Tree, size: int) -> None:
    if "stages" not in tree:
        return
    ends = tree["stages"].astype(np.int64)
    if len(ends) != STAGES or np.any(np.diff(ends) < 0) or ends[-1] > size:
        refuse("stages", f"{ends.tolist()}, expected {STAGES} rising numbers up to the file's {size} bytes")


def decode_tree(tree: Tree) -> Avatar:
    """The avatar that a tree describes.

    Errors: FormatError with code `shape`, `type`, `range`, `finite` or `value` and the field's path.
    """
    skeleton = read_skeleton(tree["skeleton"])
    translated = read_translated(tree["skeleton"], "skeleton.translated", skeleton)
    encoding = _encoding(tree["encoding"], skeleton, translated)
    components = _components(tree["encoding"], encoding.width)
    inputs = len(components.margins)
    wavelet = read_wavelet(tree["wavelet"])
    coarse = read_coarse(tree["coarse"], inputs)
    rig = read_rig(tree, skeleton, coarse.mean)
    size, count = rig.texels.size, len(rig.texels.texels)
    branches = {
        name: read_branch(tree[name], name, channels, count=count, inputs=inputs, size=size >> wavelet.levels)
        for name, channels in (("geometry", GEOMETRY_CHANNELS), ("appearance", APPEARANCE_CHANNELS))
    }
    require_bounded(components, wavelet, coarse, branches)
    rig = with_expressions(rig, tree)
    names = rig.expressions.names if rig.expressions else ()
    return Avatar(
        name=tree["name"],
        producer=tree["producer"],
        rig=rig,
        encoding=encoding,
        components=components,
        coarse=coarse,
        **branches,
        wavelet=wavelet,
        clips=_clips(tree["clips"], skeleton, translated, names, encoding.rate),
        bounds=_bounds(tree["bounds"]),
        thumbnail=_thumbnail(tree["thumbnail"]),
        notes=tree["notes"],
        surface=read_surface(tree["surface"], rig.texels) if "surface" in tree else None,
    )


def _encoding(tree: Tree, skeleton: Skeleton, among: Array) -> PoseEncoding:
    joints = indices(tree["joints"], "encoding.joints", (None,), 0, len(skeleton.names))
    if np.any(np.diff(joints) <= 0) or skeleton.root in joints:
        refuse("encoding.joints", "joints must ascend and leave out the root")
    translated = read_translated(tree, "encoding.translated", skeleton)
    if not np.isin(translated, among).all():
        refuse("encoding.translated", "joints must be among the skeleton's translated ones")
    if not 1 <= tree["window"] <= MAX_WINDOW:
        refuse("encoding.window", f"{tree['window']} frames, expected 1 to {MAX_WINDOW}")
    return PoseEncoding(
        joints=tuple(int(j) for j in joints),
        rate=_rate(tree["rate"], "encoding.rate"),
        window=tree["window"],
        remove_heading=tree["heading"],
        translated=tuple(int(j) for j in translated),
    )


def _components(tree: Tree, width: int) -> Components:
    scale = reals(tree["scale"], "encoding.scale", (width,))
    if scale.min() < np.float32(LEAST_SCALE):
        refuse("encoding.scale", f"{scale.min()}, expected {LEAST_SCALE:g} or more")
    directions = some_reals(tree["components"], "encoding.components", (None, width), axis=0)
    ranges = reals(tree["ranges"], "encoding.ranges", (2, len(directions)))
    swapped = np.flatnonzero(ranges[0] > ranges[1])
    if swapped.size:
        refuse("encoding.ranges", f"the lowest value of component {swapped[0]} is above its highest")
    margins = reals(tree["margins"], "encoding.margins", (len(directions),))
    if margins.min(initial=0) < 0:
        refuse("encoding.margins", f"{margins.min()}, expected 0 or more")
    mean = reals(tree["mean"], "encoding.mean", (width,))
    return Components(Normalization(mean, scale), directions, ranges, margins)


def _rate(rate: float, path: str) -> float:
    if not LEAST_RATE <= rate <= LARGEST_RATE:
        refuse(path, f"{rate} frames per second, expected {LEAST_RATE:g} to {LARGEST_RATE:g}")
    return rate


def _clips(
    trees: list[Tree], skeleton: Skeleton, translated: Array, expressions: tuple[str, ...], encoding_rate: float
) -> tuple[Clip, ...]:
    clips: list[Clip] = []
    added = 0.0
    for i, tree in enumerate(trees):
        clip = _clip(tree, f"clips[{i}]", skeleton, translated, len(expressions))
        times = max(encoding_rate / clip.rate, 1.0)
        numbers = len(skeleton.names) + (0 if clip.expressions is None else len(expressions))
        added += (times - 1) * len(clip) * numbers
        if times * len(clip) > MAX_FRAMES or added > MAX_ADDED:
            refuse(
                f"clips[{i}].rotations",
                f"{len(clip)} frames at a rate of {clip.rate:g}, too many for the encoding's rate of {encoding_rate:g}",
            )
        clips.append(clip)
    return tuple(clips)


def _clip(tree: Tree, path: str, skeleton: Skeleton, translated: Array, expressions: int) -> Clip:
    rotations = unit_quaternions(tree["rotations"], f"{path}.rotations", (None, len(skeleton.names), 4))
    if not len(rotations):
        refuse(f"{path}.rotations", "a clip needs at least one frame")
    translations = skeleton.with_root(reals(tree["translation"], f"{path}.translation", (len(rotations), 3)))
    if len(translated) or "translations" in tree:
        translations[:, translated] = _translations(tree, f"{path}.translations", (len(rotations), len(translated), 3))
    rate = _rate(tree["rate"], f"{path}.rate")
    weights = _weights(tree["expressions"], path, (len(rotations), expressions)) if "expressions" in tree else None
    return Clip(tree["name"], rate, rotations, translations, expressions=weights)


def _weights(tensor: Tree, path: str, shape: tuple[int, ...]) -> Array:
    weights = reals(tensor, f"{path}.expressions", shape)
    if weights.min(initial=0) < 0 or weights.max(initial=1) > 1:
        refuse(f"{path}.expressions", "a weight is not within 0 to 1")
    return weights


def _translations(tree: Tree, path: str, shape: tuple[int, ...]) -> Array:
    if "translations" not in tree:
        raise FormatError("missing", path, f"absent, but the skeleton names {shape[1]} translated joints")
    return reals(tree["translations"], path, shape)


def _bounds(tensor: Tree) -> Array:
    bounds = reals(tensor, "bounds", (2, 3))
    if np.any(bounds[0] > bounds[1]):
        refuse("bounds", f"lowest corner {bounds[0].tolist()} above highest {bounds[1].tolist()}")
    return bounds


def _thumbnail(content: Array) -> bytes:
    thumbnail = content.tobytes()
    if thumbnail and not thumbnail.startswith(PNG_SIGNATURE):
        refuse("thumbnail", "the content is no PNG")
    return thumbnail
