"""Bytes moved and floating-point operations of every dispatch of a frame, from what it binds and its constants.

Bytes: every element that a dispatch needs, read once and written once, in the type that it has on the device; what a
cache saves or a gather costs beyond that shows as a fraction of the copy bandwidth that is above or below the truth.
Operations: a multiply-add is two, a square root, division, exponential or comparison is one; bias additions are left
out, as in mua.asset.count, whose sums the network part equals.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from mua.gpu import Bound
from mua.kernels.inverse_dwt import BATCH, ROWS, plane_bytes

FLOAT = UINT = 4  # bytes
HALF = 2
DUAL_QUATERNION = 8 * FLOAT  # bytes
SPLAT, CENTRE = 32, 16  # bytes written for a splat that some eye sees, and for one that none sees
KEY = 2  # bytes
BEND = 12 * HALF  # bytes of a bent triangle or vertex
INFLUENCES = 8
SORT_GROUP = 2048  # keys that share one histogram
DIGITS = 256

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
FRAME = 6 + 6 + 3 + 5 + 6 + 6 + 3 + 9  # two edges, length, axis, shear, height's vector, its length, axis, normal
# Before; frames; in-plane map, its rotation; R, P; quaternion; all times the area.
BEND_TRIANGLE = 9 + 2 * FRAME + 6 + 7 + 3 * (6 + 8) + 10 + 6 * 5 + 45 + 12
ADD_BEND = 8 + 1 + 10 + 12  # on which side the quaternion lies; area; all of a row times it, and added
BEND_TEXEL = 3 * (11 + 2) + 2 * (8 + 12)  # shares of the corners, which of them bend and count; their sum
BEND_TEXEL += 2 * UNIT_QUATERNION + 30 + 45 + 3 * (6 + 4)  # axes, P of them, logarithms
BEND_TEXEL += 30 + QUATERNION_PRODUCT + 3 * 3  # offset, rotation, colour
BEND_TEXEL += 30 + 5 + 9 + 3 * 30  # turned normal, its dot and cross product with the other, gradients of three colours
PROJECT_EYE = (
    24 + 15 + 24 + 30 + 15 + 18 + 6 + 25 + 12 + 30 + 27
)  # eye space, slopes, Jacobian J, A = J x axes, A A^T, axes, pixel, box; direction, turned back, SH
PROJECT_SHARED = 27 + 11  # packed colours; key


@dataclass(frozen=True)
class Work:
    """The work of one or several dispatches in one frame."""

    bytes: int
    flops: int

    def __add__(self, other: "Work") -> "Work":
        return Work(self.bytes + other.bytes, self.flops + other.flops)

    def __sub__(self, other: "Work") -> "Work":
        return Work(self.bytes - other.bytes, self.flops - other.flops)


NOTHING = Work(0, 0)


def work_of(dispatch: Bound, *, share: float) -> Work:
    """Work of one dispatch where some eye sees this share of the splats."""
    return (DECODING | EXPRESSING | POSING)[dispatch.kernel](dispatch, share)


def total(dispatches: Iterable[Bound], *, share: float) -> Work:
    return sum((work_of(dispatch, share=share) for dispatch in dispatches), NOTHING)


def by_kernel(dispatches: Iterable[Bound], *, share: float) -> dict[str, Work]:
    """Work by entry point, in the order of the first dispatch of each; the drawing is not among them."""
    spent: dict[str, Work] = {}
    for dispatch in dispatches:
        spent[dispatch.kernel] = spent.get(dispatch.kernel, NOTHING) + work_of(dispatch, share=share)
    return spent


def mlp_matmul(dispatch: Bound, _: float) -> Work:
    """W [out, in] x + b: W, b and x read, y written; out x in multiply-adds. The PCA mesh is such a layer too."""
    inputs, outputs = _constants(dispatch, "inputs", "outputs")
    return Work(_bound(dispatch, "weight", "bias") + FLOAT * (inputs + outputs), 2 * outputs * inputs)


def blend_ll(dispatch: Bound, _: float) -> Work:
    """Mean, basis [C, R, n, n] and alpha [C, R] read, C n^2 written; C R n^2 multiply-adds."""
    channels, rank, size = _constants(dispatch, "channels", "rank", "size")
    moved = _bound(dispatch, "mean", "basis") + channels * (FLOAT * rank + plane_bytes(size))
    return Work(moved, 2 * channels * rank * size**2)


def blend_detail(dispatch: Bound, _: float) -> Work:
    """Mean, h, w [3, C, R, n] and alpha read, 3 C n^2 written; alpha h: 3 C R n, its products with w: 3 C R n^2."""
    channels, rank, size = _constants(dispatch, "channels", "rank", "size")
    moved = _bound(dispatch, "mean", "h", "w") + channels * (FLOAT * rank + 3 * plane_bytes(size))
    return Work(moved, 2 * 3 * channels * rank * (size + size**2))


def inverse_dwt(dispatch: Bound, _: float) -> Work:
    """Four bands [C, n, n] and two filters read, [C, 2n, 2n] written; taps (2n)^2 multiply-adds along either axis."""
    channels, size, taps = _constants(dispatch, "channels", "size", "taps")
    moved = channels * (4 * plane_bytes(size) + plane_bytes(2 * size)) + FLOAT * 2 * taps
    return Work(moved, 2 * channels * 2 * taps * (2 * size) ** 2)


def upsample_texels(dispatch: Bound, _: float) -> Work:
    """LL [C, n, n], filter, tiles and static offset read; halves of the valid texels written.

    Levels without details are one filter of `reach` samples for each texel; along the rows the texels of a column share
    what they need, `factor` of them to a sample.
    """
    channels, size, texels = _constants(dispatch, "channels", "size", "texel_count")
    reach, factor = _constants(dispatch, "reach", "factor")
    moved = _bound(dispatch, "static_offset", "tiles", "upsampling") + channels * plane_bytes(size)
    moved += HALF * BATCH * _groups(channels, BATCH) * texels
    return Work(moved, channels * texels * (2 * reach + 2 * reach // factor + 1))


def blend_vertices(dispatch: Bound, _: float) -> Work:
    """Joints' dual quaternions, 8 indices and weights for each vertex read, V dual quaternions written."""
    (vertices,) = _constants(dispatch, "vertex_count")
    moved = _bound(dispatch, "joints", "indices", "weights") + DUAL_QUATERNION * vertices
    return Work(moved, vertices * (INFLUENCES * BLEND_TERM + NORMALIZE_DUAL))


def splat_project(dispatch: Bound, share: float) -> Work:
    """Vertices and faces, place and 24 half floats of each texel read; a key and a centre or 32 bytes written.

    Vertices and faces are gathered, and counted once.
    """
    texels, eyes = _constants(dispatch, "texel_count", "eyes")
    moved = _bound(dispatch, "mesh", "vertex_dq", "faces", "texels")
    moved += texels * (ROWS * BATCH * HALF + CENTRE + KEY) + round(share * texels) * (SPLAT - CENTRE)
    return Work(moved, texels * (SKIN + eyes * PROJECT_EYE + PROJECT_SHARED))


def count_digits(dispatch: Bound, share: float) -> Work:
    """Keys read, then the elements of what is seen; a histogram of each group written; integers only."""
    read, count, _ = _keys(dispatch, share)
    return Work(read + _histograms(count), 0)


def scan_digits(dispatch: Bound, share: float) -> Work:
    """Histograms read and written, their totals written; integers only."""
    _, count, _ = _keys(dispatch, share)
    return Work(2 * _histograms(count) + UINT * DIGITS, 0)


def scatter_digits(dispatch: Bound, share: float) -> Work:
    """Keys, then elements, read with histograms and totals; elements, then the order, of what is seen written."""
    read, count, visible = _keys(dispatch, share)
    return Work(read + UINT * visible + _histograms(count) + UINT * DIGITS, 0)


def sum_targets(dispatch: Bound, _: float) -> Work:
    """Entries and weights read; mesh read and written, and how far it moves written, at each vertex that may move."""
    (vertices,) = _constants(dispatch, "vertex_count")
    moved = _bound(dispatch, "vertices", "starts", "expressions", "changes", "weights") + (2 * 3 + 4) * FLOAT * vertices
    return Work(moved, 2 * dispatch.sizes["changes"] // HALF + 3 * vertices)


def bend_triangles(dispatch: Bound, _: float) -> Work:
    """Corners read; quaternion and stretch of each triangle written."""
    (triangles,) = _constants(dispatch, "triangle_count")
    return Work(_bound(dispatch, "corners", "triangle_bends"), triangles * BEND_TRIANGLE)


def bend_vertices(dispatch: Bound, _: float) -> Work:
    """Triangles about each vertex in reach, gathered and counted once, and its gain read; their mean written."""
    (vertices,) = _constants(dispatch, "vertex_count")
    moved = _bound(dispatch, "vertices", "starts", "stars", "triangle_bends") + (4 * FLOAT + BEND) * vertices
    return Work(moved, dispatch.sizes["stars"] // UINT * ADD_BEND + vertices * 12)


def gathered(vertices: int, triangles: int, texels: int) -> Work:
    """What a face takes beside its dispatches' own buffers, of what is in reach, gathers counted once.

    Read are mesh and moves of vertices, before their triangles bend; then bends of vertices, corners of triangles,
    places of texels and the last half floats of their geometry; how their colours turn is written and read. Operations
    are those that bend and light the texels.
    """
    moved = ((3 + 4) * FLOAT + BEND) * vertices + 3 * UINT * triangles
    return Work(moved + (2 * UINT + 3 * BATCH * HALF) * texels, texels * BEND_TEXEL)


Formula = Callable[[Bound, float], Work]  # work of a dispatch, given the share of the splats that some eye sees
DECODING: dict[str, Formula] = {  # once for each pose of the clip: from pose to mesh and channels
    "MlpMatmul": mlp_matmul,
    "MlpMatmulTransposed": mlp_matmul,
    "BlendLl": blend_ll,
    "BlendDetail": blend_detail,
    "InverseDwt": inverse_dwt,
    "UpsampleTexels": upsample_texels,
}
EXPRESSING: dict[str, Formula] = {  # beside these, where a face moves
    "SumTargets": sum_targets,
    "BendTriangles": bend_triangles,
    "BendVertices": bend_vertices,
    "BendTexels": upsample_texels,  # `gathered` has what is more
    "LightTexels": upsample_texels,
}
POSING: dict[str, Formula] = {  # in every displayed frame: from there to sorted splats
    "BlendVertices": blend_vertices,
    "SplatProject": splat_project,
    "CountDigits": count_digits,
    "ScanDigits": scan_digits,
    "ScatterDigits": scatter_digits,
}


def _keys(dispatch: Bound, share: float) -> tuple[int, int, int]:
    """One sorting pass: bytes of the keys or elements it reads, their number, and how many it keeps."""
    keys, second_pass = _constants(dispatch, "key_count", "second_pass")
    visible = round(share * keys)
    return (UINT * visible, visible, visible) if second_pass else (KEY * keys, keys, visible)


def _histograms(count: int) -> int:
    return UINT * DIGITS * _groups(count, SORT_GROUP)


def _constants(dispatch: Bound, *names: str) -> tuple[int, ...]:
    return tuple(int(dispatch.constants[name]) for name in names)


def _bound(dispatch: Bound, *names: str) -> int:
    """Bytes of stored buffers, including the scales of i8 rows."""
    return sum(dispatch.sizes[name] for name in names)


def _groups(count: int, size: int) -> int:
    return -(-count // size)
