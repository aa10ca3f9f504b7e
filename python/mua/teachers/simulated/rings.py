"""The constraints about every vertex of a surface, for the vector units of a processor.

Vertices are taken sixteen at a time, all of them with about as many neighbours, and the n-th neighbours of all sixteen
together: a compiler then turns each operation into one on sixteen numbers, which it cannot where one vertex is
finished before the next.
"""

# mypy: disable-error-code="no-untyped-def, empty-body"
# (the body of the kernel is Warp's language, that of the function in it C++)

from dataclasses import dataclass

import numpy as np
import warp as wp

from mua.arrays import Array
from mua.training.warp_start import start

DEVICE = "cpu"
LANES = 16  # vertices of a block

start()

# Positions are [3 V]; what lies by neighbour is [rows x LANES]. The result of a vertex is
#     place + sum over neighbours of edge x (stretch x share + evening) - even,
# where stretch is what the edge is too long, over its length, and slack times that where it is too short.
RELAX_BLOCK = """
    constexpr int N = LANES;
    const float* __restrict from = now.data;
    const int* __restrict own = vertices.data + block * N;
    float px[N], py[N], pz[N], mx[N], my[N], mz[N];
    for (int l = 0; l < N; l++) {
        int i = own[l] * 3;
        px[l] = from[i];
        py[l] = from[i + 1];
        pz[l] = from[i + 2];
        mx[l] = -even.data[i];
        my[l] = -even.data[i + 1];
        mz[l] = -even.data[i + 2];
    }
    for (int k = starts.data[block] * N; k < starts.data[block + 1] * N; k += N) {
        const int* __restrict neighbour = neighbours.data + k;
        const float* __restrict rest = lengths.data + k;
        const float* __restrict share = shares.data + k;
        const float* __restrict evening = evenings.data + k;
        #pragma clang loop vectorize(enable) interleave(disable)
        for (int l = 0; l < N; l++) {
            int j = neighbour[l] * 3;
            float x = from[j] - px[l], y = from[j + 1] - py[l], z = from[j + 2] - pz[l];
            float length = sqrtf(x * x + y * y + z * z);
            length = length > 1e-9f ? length : 1e-9f;
            float stretch = 1.0f - rest[l] / length;
            float shorter = slack * stretch;
            float pull = (stretch > shorter ? stretch : shorter) * share[l] + evening[l];
            mx[l] += x * pull;
            my[l] += y * pull;
            mz[l] += z * pull;
        }
    }
    for (int l = 0; l < N; l++) {
        int i = own[l] * 3;
        ahead.data[i] = px[l] + mx[l];
        ahead.data[i + 1] = py[l] + my[l];
        ahead.data[i + 2] = pz[l] + mz[l];
    }
"""


@wp.func_native(RELAX_BLOCK.replace("LANES", str(LANES)))
def relax_block(
    block: int,
    vertices: wp.array[int],
    starts: wp.array[int],
    neighbours: wp.array[int],
    lengths: wp.array[float],
    shares: wp.array[float],
    evenings: wp.array[float],
    slack: float,
    even: wp.array[float],
    now: wp.array[float],
    ahead: wp.array[float],
): ...


@wp.kernel(enable_backward=False)
def relax(
    vertices: wp.array[int],
    starts: wp.array[int],
    neighbours: wp.array[int],
    lengths: wp.array[float],
    shares: wp.array[float],
    evenings: wp.array[float],
    slack: float,
    even: wp.array[float],
    now: wp.array[float],
    ahead: wp.array[float],
):
    """One Jacobi iteration of the stretch and bend constraints about the vertices of a block."""
    relax_block(wp.tid(), vertices, starts, neighbours, lengths, shares, evenings, slack, even, now, ahead)


@dataclass(frozen=True, eq=False)
class Blocks:
    """Vertices in blocks, and the edges to their neighbours in rows of a block's width."""

    vertices: Array  # [B, LANES]; the last block repeats a vertex
    starts: Array  # [B + 1] first row of each block
    edges: Array  # [R, LANES] into the edges of the one-rings, -1 where a vertex has no further one
    owners: Array  # [R, LANES] the vertex that each edge starts from

    def by_edge(self, values: Array, *, none: float) -> Array:
        """Values [E] of the edges as rows [R, LANES], `none` where there is no edge."""
        return np.where(self.edges >= 0, values[self.edges], none)


def in_blocks(
    starts: Array,  # [V + 1] first edge of each vertex
    chosen: Array,  # [n] vertices
) -> Blocks:
    """Lay out the one-rings of some of the vertices, those with most neighbours first."""
    counts = np.diff(starts)
    order = chosen[np.argsort(-counts[chosen], kind="stable")]
    vertices = np.append(order, np.repeat(order[-1:], -len(order) % LANES)).reshape(-1, LANES)
    deepest = counts[vertices].max(axis=1, initial=0)
    rows = np.concatenate([[0], np.cumsum(deepest)])
    owners = np.repeat(vertices, deepest, axis=0)
    turn = (np.arange(rows[-1]) - np.repeat(rows[:-1], deepest))[:, None]  # first neighbours, second ones, ...
    edges = np.where(turn < counts[owners], starts[owners] + turn, -1)
    return Blocks(vertices, rows, edges, owners)
