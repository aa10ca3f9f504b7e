"""Whether rays meet a surface anywhere, for the vector units of a processor: a tree of sixteen boxes in each box.

Triangles lie along a Z-order curve of their middles (Morton 1966), sixteen beside each other to a leaf, sixteen leaves
to a node and so on: a compiler turns each test of a ray into one of sixteen boxes or triangles.
"""

# mypy: disable-error-code="no-untyped-def, empty-body"
# (the body of the function that meets is C++)

from functools import reduce
from typing import Any

import numpy as np
import warp as wp

from mua.arrays import Array
from mua.training.warp_start import start

DEVICE = "cpu"
LANES = 16  # boxes of a node, triangles of a leaf
WAITING = 128  # nodes of a walk down the tree at most: fifteen of each level but the last
NOWHERE = 1e30  # metres: low corner of boxes that no ray meets, which fill up a node
SIDES = np.array([[1], [1], [1], [-1], [-1], [-1]], np.float32)
CURVE_BITS = 10  # of a place on the curve along each axis

start()

# Boxes are [nodes, 6, LANES]: low x, y, z and high x, y, z. A node below `bottom` has leaves in its boxes, any other
# the nodes from `children` on; the last is the root. Leaves are [leaves, 9, LANES]: a corner and the two edges from it
# (Moeller and Trumbore 1997). Triangles reach a little too far, so that no ray passes between two of them.
MEETS = """
    constexpr int N = LANES;
    const float ox = origin[0], oy = origin[1], oz = origin[2];
    const float dx = away[0], dy = away[1], dz = away[2];
    const float ix = 1.0f / (dx ? dx : LEAST), iy = 1.0f / (dy ? dy : LEAST), iz = 1.0f / (dz ? dz : LEAST);
    const int x = dx < 0.0f ? 3 * N : 0, y = dy < 0.0f ? 4 * N : N, z = dz < 0.0f ? 5 * N : 2 * N;
    const int beyond_x = 3 * N - x, beyond_y = 5 * N - y, beyond_z = 7 * N - z;
    int waiting[WAITING];
    int count = 1;
    waiting[0] = (int)tree.children.shape[0] - 1;
    while (count > 0) {
        const int node = waiting[--count];
        const float* __restrict box = tree.boxes.data + node * 6 * N;
        int met[N];
        #pragma clang loop vectorize(enable) interleave(disable)
        for (int l = 0; l < N; l++) {
            float near_x = (box[x + l] - ox) * ix, far_x = (box[beyond_x + l] - ox) * ix;
            float near_y = (box[y + l] - oy) * iy, far_y = (box[beyond_y + l] - oy) * iy;
            float near_z = (box[z + l] - oz) * iz, far_z = (box[beyond_z + l] - oz) * iz;
            float near = near_x > near_y ? near_x : near_y, far = far_x < far_y ? far_x : far_y;
            near = near > near_z ? near : near_z;
            far = far < far_z ? far : far_z;
            met[l] = ((near > 0.0f ? near : 0.0f) <= far * 1.00001f) & (near < FAR);
        }
        for (int l = 0; l < N; l++) {
            if (!met[l]) continue;
            if (node >= tree.bottom) {
                waiting[count++] = tree.children.data[node] + l;
                continue;
            }
            const float* __restrict leaf = tree.leaves.data + (node * N + l) * 9 * N;
            int any = 0;
            #pragma clang loop vectorize(enable) interleave(disable)
            for (int k = 0; k < N; k++) {
                float ex = leaf[3 * N + k], ey = leaf[4 * N + k], ez = leaf[5 * N + k];
                float fx = leaf[6 * N + k], fy = leaf[7 * N + k], fz = leaf[8 * N + k];
                float px = dy * fz - dz * fy, py = dz * fx - dx * fz, pz = dx * fy - dy * fx;
                float sx = ox - leaf[k], sy = oy - leaf[N + k], sz = oz - leaf[2 * N + k];
                float qx = sy * ez - sz * ey, qy = sz * ex - sx * ez, qz = sx * ey - sy * ex;
                float volume = ex * px + ey * py + ez * pz;
                float sign = volume < 0.0f ? -1.0f : 1.0f;
                float size = sign * volume, least = -1e-6f * size;
                float u = sign * (sx * px + sy * py + sz * pz), v = sign * (dx * qx + dy * qy + dz * qz);
                float t = sign * (fx * qx + fy * qy + fz * qz);
                any |= (size > 0.0f) & (u >= least) & (v >= least) & (u + v <= size - least) & (t >= 0.0f);
            }
            if (any) return true;
        }
    }
    return false;
"""
for name, number in {"LANES": str(LANES), "WAITING": str(WAITING), "FAR": "1e29f", "LEAST": "1e-20f"}.items():
    MEETS = MEETS.replace(name, number)


@wp.struct
class Boxes:
    bottom: int
    children: wp.array[int]
    boxes: wp.array[float]
    leaves: wp.array[float]


@wp.func_native(MEETS)
def meets(tree: Boxes, origin: wp.vec3, away: wp.vec3) -> bool: ...


class Tree:
    """The boxes around the triangles of a surface, which may move."""

    def __init__(self, vertices: Array, faces: Array) -> None:
        """Take vertices [V, 3] and faces [F, 3]."""
        some = faces if len(faces) else np.zeros((1, 3), int)  # a point, which no ray meets
        along = some[np.argsort(_places(vertices[some].mean(axis=1)), kind="stable")]
        self._corners = np.pad(along, ((0, -len(along) % LANES**2), (0, 0)), mode="edge").T.reshape(3, -1, LANES)
        self._places = np.full(vertices.shape, np.nan, np.float32)
        self._leaves = np.empty((self._corners.shape[1], 9, LANES), np.float32)
        self._bounds = np.empty((len(self._leaves), 6), np.float32)

    def at(self, vertices: Array) -> Any:
        """The `Boxes` of the surface at `vertices` [V, 3], for `meets`."""
        self._move(vertices.astype(np.float32))
        bounds = self._bounds
        boxes: list[Array] = []
        children: list[Array] = []
        below = 0  # the first node of the level below
        while len(bounds) > 1 or not boxes:
            bounds = np.pad(bounds, ((0, -len(bounds) % LANES), (0, 0)), constant_values=NOWHERE)
            boxes.append(bounds.reshape(-1, LANES, 6).swapaxes(1, 2) * SIDES)
            children.append(below + np.arange(0, len(bounds), LANES))
            below = sum(map(len, children[:-1]))
            bounds = _around(bounds)
        tree = Boxes()
        tree.bottom = len(boxes[0])
        tree.children = wp.array(np.concatenate(children, dtype=np.int32), device=DEVICE)
        tree.boxes = wp.array(np.concatenate(boxes).ravel(), device=DEVICE)
        tree.leaves = wp.array(self._leaves.ravel(), device=DEVICE)
        return tree

    def _move(self, places: Array) -> None:
        """Bring the leaves to places [V, 3], those alone of which a corner has moved since the last time."""
        moved = (places != self._places).any(axis=1)
        some = np.flatnonzero(moved[self._corners].any(axis=(0, 2)))
        a, b, c = places[self._corners[:, some]]  # [n, LANES, 3]
        self._leaves[some] = np.concatenate([a, b - a, c - a], axis=2).swapaxes(1, 2)
        low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
        self._bounds[some] = _around(np.concatenate([low, -high], axis=2).reshape(-1, 6))
        self._places = places


def _around(bounds: Array) -> Array:
    """Low corners and negative high ones [n / LANES, 6] of the boxes around as many boxes [n, 6] each."""
    return np.asarray(reduce(np.minimum, (bounds[lane::LANES] for lane in range(LANES))))


def _places(points: Array) -> Array:
    """How far [n] along a Z-order curve through their box points [n, 3] lie."""
    cells = (points - points.min(axis=0)) * ((2**CURVE_BITS - 1) / max(np.ptp(points, axis=0).max(), 1e-30))
    bits = cells.astype(np.int64)[..., None] >> np.arange(CURVE_BITS) & 1  # [n, 3, CURVE_BITS]
    return np.asarray((bits << 3 * np.arange(CURVE_BITS) + np.arange(3)[:, None]).sum(axis=(1, 2)))
