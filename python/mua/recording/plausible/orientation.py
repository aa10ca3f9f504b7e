"""How flat splats lie on the surface, which shows the order of quaternions and texels, and posed meshes."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.channels import ATTRIBUTES
from mua.kernels.dq_skinning import blend_texels, blend_vertices
from mua.pose.skeleton import Pose
from mua.recording.plausible.finding import Finding
from mua.rig.rig import Rig

SAMPLES = 2048  # texels that are checked
FLAT = np.log(1.5)  # between the logarithms of a flat splat's thinnest axis and the next
ALONG = 0.8  # cosine between a splat's thin axis and the normal from which on it lies on the surface; 0.2 do by chance
ASKEW, LYING = 0.85, 0.95  # shares of the flat splats that lie: fewer, and more once a mistake is undone
ROTATION, SCALE = ATTRIBUTES["rotation"], ATTRIBUTES["scale"]


class Orientations:
    """How the flat splats of one rig lie; no finding for round ones, nor where no known mistake explains it."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        count = len(rig.texels.texels)
        self._rows = np.unique(np.linspace(0, count - 1, min(count, SAMPLES)).astype(int))
        self._triangles = rig.texels.triangles[self._rows]
        self._faces = rig.mesh.faces[self._triangles]

    def __call__(
        self,
        texture: Array,  # [N, 23] at the valid texels
        mesh: Array,  # [V, 3] canonical
        pose: Pose,
        image: Array | None,  # [H, W, 23] that the texture was taken from
    ) -> Iterator[Finding]:
        normals = _normals(mesh[self._faces].astype(np.float64))
        own = _lie(texture[self._rows], normals)
        if own is None or own > ASKEW:
            return
        found = f"texture: {100 * own:.0f} % of flat splats lie on the surface"
        for question, some in self._attempts(texture, normals, pose, image):
            lie = _lie(*some)
            if lie is not None and lie > LYING:
                yield Finding(f"{found}, and {100 * lie:.0f} % {question}", certain=True)
                return

    def _attempts(
        self, texture: Array, normals: Array, pose: Pose, image: Array | None
    ) -> Iterator[tuple[str, tuple[Array, Array]]]:
        """Other readings of the values: a question, then splats [n, 23] and the normals [n, 3] they would lie on."""
        some = texture[self._rows].copy()
        some[:, ROTATION] = np.roll(some[:, ROTATION], 1, axis=1)
        yield "if quaternions are xyzw: are they? wxyz is expected", (some, normals)
        posed = "in posed space: are they posed? canonical space is expected"
        yield posed, (texture[self._rows], self._posed(normals, pose))
        for found, ordered in self._orders(texture) if image is None else _turned(image, self._rig.texels.texels):
            yield found, (ordered[self._rows], normals)

    def _posed(self, normals: Array, pose: Pose) -> Array:
        rig = self._rig
        joints = rig.skeleton.skinning(pose.rotations, pose.translations)
        vertices = blend_vertices(joints, rig.skin_indices, rig.skin_weights)
        barycentrics = rig.texels.barycentrics[self._rows]
        return rotation.rotate(blend_texels(vertices, rig.mesh.faces, self._triangles, barycentrics)[:, :4], normals)

    def _orders(self, texture: Array) -> Iterator[tuple[str, Array]]:
        """The values as if valid texels had been counted in another order."""
        row, column = np.divmod(self._rig.texels.texels, self._rig.texels.size)
        for by_column, up, left in product((False, True), repeat=3):
            keys = (-column if left else column, -row if up else row)
            if by_column or up or left:
                ordered = np.empty_like(texture)
                ordered[np.lexsort(keys[::-1] if by_column else keys)] = texture
                first = f"column by column{', from the last' if left else ''}" if by_column else "row by row"
                found = f"{first}{', from the bottom' if up else ''}"
                yield f"if texels are counted {found}: are they? row by row from the top is expected", ordered


def _turned(
    image: Array,  # [H, W, 23]
    texels: Array,  # [N]
) -> Iterator[tuple[str, Array]]:
    """The values at the valid texels of a transposed or mirrored image."""
    for transposed, up, left in product((False, True), repeat=3):
        if not (transposed or up or left):
            continue
        turned = image.swapaxes(0, 1) if transposed else image
        turned = turned[:: -1 if up else 1, :: -1 if left else 1]
        names = [name for name, so in (("transposed", transposed), ("upside down", up), ("mirrored", left)) if so]
        question = f"if the texture is {' and '.join(names)}: is it? [row, column] from the top left is expected"
        yield question, turned.reshape(-1, image.shape[-1])[texels]


def _lie(
    some: Array,  # [n, 23]
    normals: Array,  # [n, 3] unit
) -> float | None:
    """The share of flat splats whose thin axis is along the normal; None where most splats are not flat."""
    some = np.asarray(some, dtype=np.float64)
    scales, q = np.sort(some[:, SCALE], axis=1), some[:, ROTATION]
    lengths = np.linalg.norm(q, axis=1)
    flat = (scales[:, 1] - scales[:, 0] > FLAT) & (lengths > 0)
    if flat.mean() < 0.5:
        return None
    axis = np.eye(3)[np.argmin(some[flat][:, SCALE], axis=1)]
    turned = rotation.rotate(q[flat] / lengths[flat, None], axis)
    return float(np.mean(np.abs(np.sum(turned * normals[flat], axis=1)) > ALONG))


def _normals(
    corners: Array,  # [n, 3, 3]
) -> Array:
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-30))
