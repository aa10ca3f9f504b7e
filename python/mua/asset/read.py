"""Read a `.muaavatar` file: every shape relation, range and finiteness is checked before an Avatar leaves here."""

import zlib

import numpy as np

from mua import rotation
from mua.arguments import PathLike, as_path
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.flatbuffer import FormatError, Tree, parse
from mua.asset.magnitude import require_bounded
from mua.asset.packing import unpack
from mua.asset.sizes import require_sizes
from mua.asset.tensors import indices, reals
from mua.avatar.model import Branch, Coarse, DetailBand, Layer, Mlp, Wavelet
from mua.errors import InputError
from mua.limits import (
    BARYCENTRIC_SLACK,
    BIND_BOUND,
    LARGEST,
    LARGEST_RATE,
    LARGEST_TAP,
    LEAST_RATE,
    LEAST_SCALE,
    MAX_ADDED,
    MAX_FRAMES,
    MAX_INFLUENCES,
    MAX_TAPS,
    MAX_WINDOW,
    STAGES,
    UNIT_BOUND,
    WEIGHT_BOUND,
)
from mua.pose.clip import Clip
from mua.pose.encoding import Components, Normalization, PoseEncoding
from mua.pose.skeleton import Skeleton
from mua.rig.character import Mesh
from mua.rig.rig import Rig
from mua.rig.surface import END, Surface, block_triangles, blocks, codes_of, count_codes
from mua.rig.texel_map import CHIEF, TexelMap, centre_barycentrics

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
            "checksum", "crc32", f"{tree['crc32']:08x}, but the content gives {found:08x}: the file is damaged"
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
        _refuse("stages", f"{ends.tolist()}, expected {STAGES} rising numbers up to the file's {size} bytes")


def decode_tree(tree: Tree) -> Avatar:
    """The avatar that a tree describes.

    Errors: FormatError with code `shape`, `type`, `range`, `finite` or `value` and the field's path.
    """
    skeleton = _skeleton(tree["skeleton"])
    translated = _translated(tree["skeleton"], "skeleton.translated", skeleton)
    encoding = _encoding(tree["encoding"], skeleton, translated)
    components = _components(tree["encoding"], encoding.width)
    inputs = len(components.margins)
    wavelet = _wavelet(tree["wavelet"])
    coarse = _coarse(tree["coarse"], inputs)
    rig = _rig(tree, skeleton, coarse.mean)
    size, count = rig.texels.size, len(rig.texels.texels)
    branches = {
        name: _branch(tree[name], name, channels, count=count, inputs=inputs, size=size >> wavelet.levels)
        for name, channels in (("geometry", GEOMETRY_CHANNELS), ("appearance", APPEARANCE_CHANNELS))
    }
    require_bounded(components, wavelet, coarse, branches)
    return Avatar(
        name=tree["name"],
        producer=tree["producer"],
        rig=rig,
        encoding=encoding,
        components=components,
        coarse=coarse,
        **branches,
        wavelet=wavelet,
        clips=_clips(tree["clips"], skeleton, translated, encoding.rate),
        bounds=_bounds(tree["bounds"]),
        thumbnail=_thumbnail(tree["thumbnail"]),
        notes=tree["notes"],
        surface=_surface(tree["surface"], rig.texels) if "surface" in tree else None,
    )


def _refuse(field: str, sentence: str) -> None:
    raise FormatError("value", field, sentence)


def _skeleton(tree: Tree) -> Skeleton:
    count = len(tree["names"])
    parents = indices(tree["parents"], "skeleton.parents", (count,), -1, count)
    late = np.flatnonzero(parents >= np.arange(count))
    if late.size:
        _refuse("skeleton.parents", f"joint {late[0]} stands before its parent {parents[late[0]]}")
    if not tree["root"] < count:
        _refuse("skeleton.root", f"{tree['root']}, but there are {count} joints")
    skeleton = Skeleton(
        names=tuple(tree["names"]),
        parents=parents,
        bind_rotations=_unit(tree["bind_rotations"], "skeleton.bind_rotations", (count, 4)),
        bind_translations=reals(tree["bind_translations"], "skeleton.bind_translations", (count, 3)),
        root=tree["root"],
    )
    stated = reals(tree["bind_inverse"], "skeleton.bind_inverse", (count, 8))
    gaps = [np.abs(stated - sign * skeleton.bind_inverse).max(axis=1) for sign in (1, -1)]  # of a dual quaternion
    gap = np.minimum(*gaps).max()
    if gap > BIND_BOUND:
        _refuse("skeleton.bind_inverse", f"differs by {gap:.1e} from the inverse of the bind pose")
    return skeleton


def _some(tensor: Tree, path: str, shape: tuple[int | None, ...], *, axis: int) -> Array:
    """Reals of which there is at least one along the axis: components, or a rank."""
    values = reals(tensor, path, shape)
    if not values.shape[axis]:
        raise FormatError("shape", f"{path}.shape", f"side {axis} is 0, expected 1 or more")
    return values


def _unit(tensor: Tree, path: str, shape: tuple[int | None, ...]) -> Array:
    """Unit quaternions [..., 4], renormalised after storage."""
    q = reals(tensor, path, shape).astype(np.float64)
    lengths = np.linalg.norm(q, axis=-1)
    if np.abs(lengths - 1).max(initial=0) > UNIT_BOUND:
        worst = lengths.ravel()[np.abs(lengths - 1).argmax()]
        _refuse(path, f"a quaternion of length {worst:.4g}, expected 1")
    return rotation.normalize(q)


def _translated(tree: Tree, path: str, skeleton: Skeleton) -> Array:
    """Joints beside the root that move in their parents; none in a file that names none."""
    if "translated" not in tree:
        return np.zeros(0, dtype=np.int32)
    joints = indices(tree["translated"], path, (None,), 0, len(skeleton.names))
    if np.any(np.diff(joints) <= 0) or skeleton.root in joints:
        _refuse(path, "joints must ascend and leave out the root")
    return joints


def _encoding(tree: Tree, skeleton: Skeleton, among: Array) -> PoseEncoding:
    joints = indices(tree["joints"], "encoding.joints", (None,), 0, len(skeleton.names))
    if np.any(np.diff(joints) <= 0) or skeleton.root in joints:
        _refuse("encoding.joints", "joints must ascend and leave out the root")
    translated = _translated(tree, "encoding.translated", skeleton)
    if not np.isin(translated, among).all():
        _refuse("encoding.translated", "joints must be among the skeleton's translated ones")
    if not 1 <= tree["window"] <= MAX_WINDOW:
        _refuse("encoding.window", f"{tree['window']} frames, expected 1 to {MAX_WINDOW}")
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
        _refuse("encoding.scale", f"{scale.min()}, expected {LEAST_SCALE:g} or more")
    directions = _some(tree["components"], "encoding.components", (None, width), axis=0)
    ranges = reals(tree["ranges"], "encoding.ranges", (2, len(directions)))
    swapped = np.flatnonzero(ranges[0] > ranges[1])
    if swapped.size:
        _refuse("encoding.ranges", f"the lowest value of component {swapped[0]} is above its highest")
    margins = reals(tree["margins"], "encoding.margins", (len(directions),))
    if margins.min(initial=0) < 0:
        _refuse("encoding.margins", f"{margins.min()}, expected 0 or more")
    mean = reals(tree["mean"], "encoding.mean", (width,))
    return Components(Normalization(mean, scale), directions, ranges, margins)


def _rate(rate: float, path: str) -> float:
    if not LEAST_RATE <= rate <= LARGEST_RATE:
        _refuse(path, f"{rate} frames per second, expected {LEAST_RATE:g} to {LARGEST_RATE:g}")
    return rate


def _rig(tree: Tree, skeleton: Skeleton, vertices: Array) -> Rig:
    template, count = tree["template"], len(vertices)
    uv = reals(template["uv"], "template.uv", (None, 2))
    faces = indices(template["faces"], "template.faces", (None, 3), 0, count)
    uv_faces = indices(template["uv_faces"], "template.uv_faces", (len(faces), 3), 0, len(uv))
    influences = (count, MAX_INFLUENCES)
    weights = reals(template["skin_weights"], "template.skin_weights", influences)
    sums = weights.sum(axis=1)
    if weights.min(initial=0) < 0 or np.abs(sums - 1).max(initial=0) > WEIGHT_BOUND:
        vertex = int(np.abs(sums - 1).argmax())
        _refuse("template.skin_weights", f"weights of vertex {vertex} sum to {sums[vertex]:.4g} or one is negative")
    if np.any(weights[:, 1:] > weights[:, :-1]):
        vertex = int((weights[:, 1:] > weights[:, :-1]).any(axis=1).argmax())
        _refuse("template.skin_weights", f"weights of vertex {vertex} do not begin with the largest")
    mesh = Mesh(vertices=vertices, faces=faces, uv=uv, uv_faces=uv_faces)
    return Rig(
        skeleton=skeleton,
        mesh=mesh,
        skin_indices=indices(template["skin_indices"], "template.skin_indices", influences, 0, len(skeleton.names)),
        skin_weights=weights,
        texels=_texels(tree["texels"], mesh),
    )


def _texels(tree: Tree, mesh: Mesh) -> TexelMap:
    size = tree["size"]
    texels = indices(tree["texels"], "texels.texels", (None,), 0, size * size)
    if np.any(np.diff(texels) <= 0):
        _refuse("texels.texels", "texels must ascend")
    triangles = indices(tree["triangles"], "texels.triangles", (len(texels),), 0, len(mesh.faces))
    first = _barycentrics(tree, mesh, texels, triangles)
    barycentrics = np.column_stack([first, 1 - first.sum(axis=1)])
    if barycentrics.min(initial=0) < -BARYCENTRIC_SLACK:
        _refuse("texels.barycentrics", f"{barycentrics.min():.3g}, expected 0 to 1")
    one_sided = _one_sided(tree["one_sided"], len(texels)) if "one_sided" in tree else None
    if not 0 <= tree["length"] <= LARGEST:
        _refuse("texels.length", f"{tree['length']}, expected 0 to {LARGEST:.6g}")
    found = TexelMap(
        size=size,
        texels=texels,
        triangles=triangles,
        barycentrics=np.maximum(barycentrics, 0),
        claimed_twice=0,
        one_sided=one_sided,
        levels=tuple(level["blocks"] for level in tree["levels"]),
        length=tree["length"],
    )
    _require_levels(found)
    return found


def _require_levels(texels: TexelMap) -> None:
    for number, codes in enumerate(texels.levels or ()):
        path, (_, four) = f"texels.levels[{number}].blocks", texels.blocks()
        if len(codes) != len(four):
            raise FormatError("shape", path, f"{len(codes)} bytes, expected {len(four)}")
        kinds = codes[:, None] >> 2 * np.arange(4) & 3
        wrong = np.flatnonzero(((kinds == CHIEF).sum(axis=1) != 1) | (kinds.astype(bool) & (four < 0)).any(axis=1))
        if wrong.size:
            _refuse(path, f"block {wrong[0]} has not one chief, or a member that is no valid texel")
        texels = texels.halved()


def _one_sided(content: Array, count: int) -> Array:
    """[N] bool, from a bit for each texel."""
    expected = -(-count // 8)
    if len(content) != expected:
        raise FormatError("shape", "texels.one_sided", f"{len(content)} bytes, expected {expected}")
    return np.unpackbits(content, count=count, bitorder="little").astype(bool)


def _barycentrics(tree: Tree, mesh: Mesh, texels: Array, triangles: Array) -> Array:
    """[N, 2] as stored, or computed where only those of the listed texels are."""
    if "listed" not in tree:
        return reals(tree["barycentrics"], "texels.barycentrics", (len(texels), 2))
    listed = indices(tree["listed"], "texels.listed", (None,), 0, len(texels))
    if np.any(np.diff(listed) <= 0):
        _refuse("texels.listed", "texels must ascend")
    stored = reals(tree["barycentrics"], "texels.barycentrics", (len(listed), 2))
    found = centre_barycentrics(mesh, tree["size"], texels, triangles)
    found[listed] = stored
    if not np.isfinite(found).all():
        _refuse("texels.listed", "a texel is not listed, but its triangle has no area in UV")
    return found


def _wavelet(tree: Tree) -> Wavelet:
    low, high = tree["rec_lo"], tree["rec_hi"]
    if low.size != high.size or low.size % 2 or not 2 <= low.size <= MAX_TAPS:
        _refuse("wavelet.rec_lo", f"{low.size} and {high.size} taps, expected an even number of each, 2 to {MAX_TAPS}")
    if not (np.isfinite(low).all() and np.isfinite(high).all()):
        raise FormatError("finite", "wavelet.rec_lo", "a value is not finite")
    largest = max(np.abs(low).max(), np.abs(high).max())
    if largest > LARGEST_TAP:
        _refuse("wavelet.rec_lo", f"a tap of {largest:.4g}, expected {-LARGEST_TAP:g} to {LARGEST_TAP:g}")
    return Wavelet(name=tree["name"], levels=tree["levels"], rec_lo=low, rec_hi=high)


def _mlp(layers: list[Tree], path: str, first: int, last: int) -> Mlp:
    mlp: list[Layer] = []
    width = first
    for i, layer in enumerate(layers):
        weight = reals(layer["weight"], f"{path}[{i}].weight", (None, width))
        width = len(weight)
        mlp.append(Layer(weight=weight, bias=reals(layer["bias"], f"{path}[{i}].bias", (width,))))
    if not mlp or width != last:
        raise FormatError("shape", path, f"{len(mlp)} layers with {width} outputs, expected {last}")
    return tuple(mlp)


def _coarse(tree: Tree, inputs: int) -> Coarse:
    mean = reals(tree["mean"], "coarse.mean", (None, 3))
    basis = _some(tree["basis"], "coarse.basis", (None, len(mean), 3), axis=0)
    return Coarse(mlp=_mlp(tree["mlp"], "coarse.mlp", inputs, len(basis)), mean=mean, basis=basis)


def _branch(tree: Tree, path: str, channels: int, *, count: int, inputs: int, size: int) -> Branch:
    """One branch over `count` texels with LL of `size`, driven by so many components."""
    basis = _some(tree["ll_basis"], f"{path}.ll_basis", (channels, None, size, size), axis=1)
    details = tuple(
        _detail(band, f"{path}.details[{i}]", channels, size << i) for i, band in enumerate(tree["details"])
    )
    outputs = channels * (basis.shape[1] + sum(band.h.shape[2] for band in details))
    return Branch(
        mlp=_mlp(tree["mlp"], f"{path}.mlp", inputs, outputs),
        ll_mean=reals(tree["ll_mean"], f"{path}.ll_mean", (channels, size, size)),
        ll_basis=basis,
        details=details,
        static=reals(tree["static_offset"], f"{path}.static_offset", (channels, count)),
    )


def _detail(tree: Tree, path: str, channels: int, size: int) -> DetailBand:
    h = _some(tree["h"], f"{path}.h", (3, channels, None, size), axis=2)
    return DetailBand(
        mean=reals(tree["mean"], f"{path}.mean", (3, channels, size, size)),
        h=h,
        w=reals(tree["w"], f"{path}.w", h.shape),
    )


def _clips(trees: list[Tree], skeleton: Skeleton, translated: Array, encoding_rate: float) -> tuple[Clip, ...]:
    clips: list[Clip] = []
    added = 0.0
    for i, tree in enumerate(trees):
        clip = _clip(tree, f"clips[{i}]", skeleton, translated)
        times = max(encoding_rate / clip.rate, 1.0)
        added += (times - 1) * len(clip) * len(skeleton.names)
        if times * len(clip) > MAX_FRAMES or added > MAX_ADDED:
            _refuse(
                f"clips[{i}].rotations",
                f"{len(clip)} frames at a rate of {clip.rate:g}, too many for the encoding's rate of {encoding_rate:g}",
            )
        clips.append(clip)
    return tuple(clips)


def _clip(tree: Tree, path: str, skeleton: Skeleton, translated: Array) -> Clip:
    rotations = _unit(tree["rotations"], f"{path}.rotations", (None, len(skeleton.names), 4))
    if not len(rotations):
        _refuse(f"{path}.rotations", "a clip needs at least one frame")
    translations = skeleton.with_root(reals(tree["translation"], f"{path}.translation", (len(rotations), 3)))
    if len(translated) or "translations" in tree:
        translations[:, translated] = _translations(tree, f"{path}.translations", (len(rotations), len(translated), 3))
    return Clip(tree["name"], _rate(tree["rate"], f"{path}.rate"), rotations, translations)


def _translations(tree: Tree, path: str, shape: tuple[int, ...]) -> Array:
    if "translations" not in tree:
        raise FormatError("missing", path, f"absent, but the skeleton names {shape[1]} translated joints")
    return reals(tree["translations"], path, shape)


def _bounds(tensor: Tree) -> Array:
    bounds = reals(tensor, "bounds", (2, 3))
    if np.any(bounds[0] > bounds[1]):
        _refuse("bounds", f"lowest corner {bounds[0].tolist()} above highest {bounds[1].tolist()}")
    return bounds


def _surface(tree: Tree, texels: TexelMap) -> Surface:
    corners, runs = blocks(texels), tree["runs"]
    if count_codes(runs) != len(corners):
        raise FormatError("shape", "surface.runs", f"{count_codes(runs)} codes, expected {len(corners)}")
    if block_triangles(corners, codes_of(runs)).min(initial=0) < 0:
        _refuse("surface.runs", "a triangle has a corner that is no valid texel")
    return Surface(runs, indices(tree["strips"], "surface.strips", (None,), END, 2 * len(texels.texels)))


def _thumbnail(content: Array) -> bytes:
    thumbnail = content.tobytes()
    if thumbnail and not thumbnail.startswith(PNG_SIGNATURE):
        _refuse("thumbnail", "the content is no PNG")
    return thumbnail
