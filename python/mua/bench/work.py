"""Bytes moved and floating-point operations of every kernel of a frame, from the shapes of its dispatches.

Bytes: every element that a dispatch needs, read once and written once, in the type that it has on the device; what a
cache saves or a gather costs beyond that shows as a fraction of the copy bandwidth that is above or below the truth.
Operations: a multiply-add is two, a square root, division, exponential or comparison is one; bias additions are left
out, as in mua.asset.count, whose sums the network part equals.
"""

from dataclasses import dataclass

from mua.asset.flatbuffer import Tree
from mua.kernels.inverse_dwt import BATCH, ROWS, texel_tiles, upsampling_taps

FLOAT = UINT = 4  # bytes
HALF = 2
DUAL_QUATERNION = 8 * FLOAT  # bytes
SPLAT, CENTRE = 32, 16  # bytes: of a splat that some eye sees, and of another
KEY = 2  # bytes
INFLUENCES = 8
SORT_GROUP = 2048  # keys that share one histogram
DIGITS = 256
TILE = UINT + 16 * 2 * UINT  # bytes that say where a tile lies and which of its texels are valid

# Operations of the posing kernels, counted on their references.
BLEND_TERM = 8 + 16  # dot product with the reference of the signs, 8 multiply-adds
NORMALIZE_DUAL = 8 + 1 + 8  # squared norm, root, 8 quotients
DUAL_TRANSFORM = 30 + 24 + 6  # rotate a vector; 2 vec(dual conj(real)); add both
QUATERNION_PRODUCT = 28
UNIT_QUATERNION = 8 + 1 + 4
AXES = 30 + 9  # rotation matrix, its scaled columns
ACTIVATIONS = 3 + 4  # three exponentials, the logistic function
SKIN = 3 * BLEND_TERM + NORMALIZE_DUAL + 18 + DUAL_TRANSFORM + QUATERNION_PRODUCT + UNIT_QUATERNION + AXES
SKIN += ACTIVATIONS  # 18: the barycentric point and the offset
PROJECT_EYE = (
    24 + 15 + 24 + 30 + 15 + 18 + 6 + 25
)  # eye space, slopes, Jacobian J, A = J x axes, A A^T, axes, pixel, box
PROJECT_SHARED = 12 + 30 + 27 + 11  # direction, turned back, SH; key


@dataclass(frozen=True)
class Work:
    """What a kernel must do in one frame."""

    bytes: int
    flops: int

    def __add__(self, other: "Work") -> "Work":
        return Work(self.bytes + other.bytes, self.flops + other.flops)


def frame_work(
    tree: Tree,  # of the file, for the sizes and stored types of its tensors
    *,
    visible: int,  # splats that some eye sees
    eyes: int,
) -> dict[str, Work]:
    """Work of one frame by kernel entry point, in frame order; the drawing depends on overdraw and is left out."""
    texels = int(tree["texels"]["texels"]["shape"][0])
    return {
        **_decode(tree),
        "BlendVertices": blend_vertices(len(tree["skeleton"]["names"]), _shape(tree["template"]["skin_indices"])[0]),
        "SplatProject": splat_project(tree, visible, eyes),
        **splat_sort(texels, visible),
    }


def mlp_matmul(layer: Tree) -> Work:
    """W [out, in] x + b: W, b and x read, y written; out x in multiply-adds."""
    outputs, inputs = _shape(layer["weight"])
    return Work(_stored(layer["weight"], layer["bias"]) + FLOAT * (inputs + outputs), 2 * outputs * inputs)


def mlp_matmul_transposed(coarse: Tree) -> Work:
    """The PCA mesh: basis [K, V, 3], mean and K coefficients read, 3 V coordinates written; 3 K V multiply-adds."""
    components, vertices, _ = _shape(coarse["basis"])
    moved = _stored(coarse["basis"], coarse["mean"]) + FLOAT * (components + 3 * vertices)
    return Work(moved, 2 * 3 * components * vertices)


def blend_ll(branch: Tree) -> Work:
    """Mean, basis [C, R, n, n] and alpha [C, R] read, C n^2 written; C R n^2 multiply-adds."""
    channels, rank, size, _ = _shape(branch["ll_basis"])
    moved = _stored(branch["ll_mean"], branch["ll_basis"]) + FLOAT * channels * (rank + size**2)
    return Work(moved, 2 * channels * rank * size**2)


def blend_detail(band: Tree) -> Work:
    """Mean, h, w [3, C, R, n] and alpha read, 3 C n^2 written; alpha h: 3 C R n, its products with w: 3 C R n^2."""
    _, channels, rank, size = _shape(band["h"])
    moved = _stored(band["mean"], band["h"], band["w"]) + FLOAT * channels * (rank + 3 * size**2)
    return Work(moved, 2 * 3 * channels * rank * (size + size**2))


def inverse_dwt(channels: int, size: int, taps: int) -> Work:
    """Four bands [C, n, n] and two filters read, [C, 2n, 2n] written; taps (2n)^2 multiply-adds along either axis."""
    moved = FLOAT * (channels * (4 * size**2 + (2 * size) ** 2) + 2 * taps)
    return Work(moved, 2 * channels * 2 * taps * (2 * size) ** 2)


def upsample_texels(branch: Tree, upsampling: tuple[int, int], tiles: int) -> Work:
    """LL [C, n, n], filter [reach, factor], 132 bytes for each of the tiles and static offset read; halves written.

    Levels without details are one filter of `reach` samples for each texel; along the rows the texels of a column share
    what they need, `factor` of them to a sample.
    """
    channels, texels = _shape(branch["static_offset"])
    size = _shape(branch["ll_mean"])[-1] << len(branch["details"])
    reach, factor = upsampling
    moved = _stored(branch["static_offset"]) + TILE * tiles
    moved += FLOAT * (channels * size**2 + reach * factor) + HALF * BATCH * _groups(channels, BATCH) * texels
    return Work(moved, channels * texels * (2 * reach + 2 * reach // factor + 1))


def blend_vertices(joints: int, vertices: int) -> Work:
    """Joints' dual quaternions, 8 indices and weights for each vertex read, V dual quaternions written."""
    influences = INFLUENCES * (UINT + FLOAT)
    moved = DUAL_QUATERNION * (joints + vertices) + influences * vertices
    return Work(moved, vertices * (INFLUENCES * BLEND_TERM + NORMALIZE_DUAL))


def splat_project(tree: Tree, visible: int, eyes: int) -> Work:
    """Vertices and faces, place and 24 half floats of each texel read; a key and a centre or 32 bytes written.

    Vertices and faces are gathered, and counted once.
    """
    texels, vertices = _shape(tree["texels"]["texels"])[0], _shape(tree["coarse"]["mean"])[0]
    shared = (DUAL_QUATERNION + 3 * FLOAT) * vertices + 3 * UINT * _shape(tree["template"]["faces"])[0]
    texel = 2 * UINT + ROWS * BATCH * HALF + CENTRE + KEY
    moved = shared + texels * texel + visible * (SPLAT - CENTRE)
    return Work(moved, texels * (SKIN + eyes * PROJECT_EYE + PROJECT_SHARED))


def splat_sort(texels: int, visible: int) -> dict[str, Work]:
    """Keys, then elements, counted, scanned and scattered; integers only."""
    first, last = (UINT * DIGITS * _groups(count, SORT_GROUP) for count in (texels, visible))
    totals = 2 * UINT * DIGITS
    read = KEY * texels + UINT * visible
    moved = {
        "CountDigits": read + first + last,
        "ScanDigits": 2 * (first + last) + totals,
        "ScatterDigits": read + 2 * UINT * visible + first + last + totals,
    }
    return {name: Work(once, 0) for name, once in moved.items()}


def _decode(tree: Tree) -> dict[str, Work]:
    """Network, mesh, subbands and synthesis."""
    branches = (tree["geometry"], tree["appearance"])
    taps = len(tree["wavelet"]["rec_lo"])
    nothing = Work(0, 0)
    layers = [layer for part in (tree["coarse"], *branches) for layer in part["mlp"]]
    tiles = len(texel_tiles(tree["texels"]["texels"]["data"].view("<u4"), int(tree["texels"]["size"]))[0])
    full = nothing
    for branch in branches:
        channels, size, _ = _shape(branch["ll_mean"])
        full = sum((inverse_dwt(channels, size << i, taps) for i in range(len(branch["details"]))), full)
    return {
        "MlpMatmul": sum(map(mlp_matmul, layers), nothing),
        "MlpMatmulTransposed": mlp_matmul_transposed(tree["coarse"]),
        "BlendLl": sum(map(blend_ll, branches), nothing),
        "BlendDetail": sum((blend_detail(band) for branch in branches for band in branch["details"]), nothing),
        "InverseDwt": full,
        "UpsampleTexels": sum((upsample_texels(b, _upsampling(tree, b), tiles) for b in branches), nothing),
    }


def _upsampling(tree: Tree, branch: Tree) -> tuple[int, int]:
    """Reach and factor of a branch's levels without details."""
    wavelet = tree["wavelet"]
    taps, _ = upsampling_taps(wavelet["rec_lo"], int(wavelet["levels"]) - len(branch["details"]))
    return taps.shape[0], taps.shape[1]


def _shape(tensor: Tree) -> tuple[int, ...]:
    return tuple(int(n) for n in tensor["shape"])


def _stored(*tensors: Tree) -> int:
    """Bytes of tensors as they are stored, the scales of i8 rows included."""
    return sum(t["data"].nbytes + (t["scale"].nbytes if "scale" in t else 0) for t in tensors)


def _groups(count: int, size: int) -> int:
    return -(-count // size)
