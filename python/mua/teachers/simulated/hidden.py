"""What texels show that no view can reach: teeth behind lips that nothing opens, skin in a shoe, pages under a cover.

Their splats shine through what lies close above them, since splats are sorted by their centres alone, and fill the gaps
of coarse ones. They show the colour of what is seen instead.
"""

# mypy: disable-error-code="index, operator, attr-defined, no-untyped-def, var-annotated"
# (the body of the kernel is Warp's language, not Python)

import os
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
import warp as wp
from scipy.spatial import cKDTree

from mua import rotation
from mua.arrays import Array
from mua.rig.character import Character
from mua.rig.skinning import moving_joints
from mua.teachers.simulated.rays import Boxes, Tree, meets
from mua.teachers.simulated.skinned_surface import SkinnedSurface
from mua.training.threads import in_order
from mua.training.warp_start import NO_NANS, start

DEVICE = "cpu"
SOLID = 0.9  # opacity from which a texel hides what is behind it
DIRECTIONS = 48  # in which a point looks out, others in each pose
POSES = 8  # in which joints are turned at random, beside the bind pose
TURN = np.radians(120)  # of a joint, at most
WELL_MOVED = 0.1  # of the farthest: vertices that an expression moves less uncover nothing
FAR = wp.constant(1.0e6)  # metres: as far as a ray goes
LAYERS = wp.constant(4)  # of cut-out surface that a ray passes
LIFT = 5e-4  # metres on a person, from which a ray starts: what lies closer is the surface itself

start()
wp.set_module_options(NO_NANS)


@wp.kernel(enable_backward=False)
def look_out(
    tree: Boxes,
    cut: wp.uint64,
    uv: wp.array[wp.vec2],
    shown: wp.array2d[wp.bool],
    points: wp.array[wp.vec3],
    directions: wp.array[wp.vec3],
    lift: float,
    seen: wp.array[wp.bool],
):
    """Whether a ray from each point meets no triangle of a tree, and `cut` only where the texture shows nothing."""
    i = wp.tid()
    for k in range(directions.shape[0]):
        if not seen[i]:
            away = directions[k]
            start = points[i] + lift * away
            free = not meets(tree, start, away)
            for _layer in range(LAYERS):
                if free and not seen[i]:
                    hit = wp.mesh_query_ray(cut, start, away, FAR)
                    if hit.result:
                        corner = 3 * hit.face
                        at = hit.u * uv[corner] + hit.v * uv[corner + 1] + (1.0 - hit.u - hit.v) * uv[corner + 2]
                        row = wp.clamp(int(at[1] * float(shown.shape[0])), 0, shown.shape[0] - 1)
                        free = not shown[row, wp.clamp(int(at[0] * float(shown.shape[1])), 0, shown.shape[1] - 1)]
                        start += (hit.t + lift) * away
                    else:
                        seen[i] = True


def showing_instead(
    character: Character,
    corners: Array,  # [N, 3] vertices of the triangle of each texel
    barycentrics: Array,  # [N, 3]
    *,
    solid: Array,  # [N] bool: texels that nothing shows through
) -> Array:
    """The texel [N] whose colour each one shows: its own, or that of the nearest solid one that can be seen."""
    cut = np.asarray(np.isin(character.mesh.faces, corners[~solid]).all(axis=1))
    covers = _Covers(character, cut=cut)
    lift = LIFT * float(np.ptp(character.mesh.vertices, axis=0).max())
    hidden = np.arange(len(corners))
    rng = np.random.default_rng(0)
    own_points = np.einsum("nk,nkc->nc", barycentrics, character.mesh.vertices[corners])
    for places, reached in _shapes(character, rng):
        asked = np.full(len(hidden), True) if reached is None else reached(own_points[hidden])
        points = np.einsum("nk,nkc->nc", barycentrics[hidden[asked]], places[corners[hidden[asked]]])
        away = rng.standard_normal((DIRECTIONS, 3))
        away /= np.linalg.norm(away, axis=1, keepdims=True)
        asked[asked] = covers.seen(points, places, away=away, lift=lift)
        hidden = hidden[~asked]
    shown, own = np.arange(len(corners)), np.ones(len(corners), bool)
    own[hidden] = False
    if len(hidden) and (own & solid).any():
        seen = np.flatnonzero(own & solid)
        shown[hidden] = seen[cKDTree(own_points[seen]).query(own_points[hidden])[1]]
    return shown


def _shapes(character: Character, rng: np.random.Generator) -> Iterator[tuple[Array, Callable[[Array], Array] | None]]:
    """The surface [V, 3] in the bind pose, with joints turned at random, and in each of the character's expressions.

    With an expression comes which of some points [n, 3] of the bind pose it may uncover; None: any.
    """
    surface, skeleton, bind = SkinnedSurface(character), character.skeleton, character.mesh.vertices
    for turned in _poses(character, rng):
        yield surface.posed(skeleton.skinning(turned, skeleton.bind_translations)).places, None
    if character.expressions is not None:
        for alone in np.eye(len(character.expressions)):
            moved = character.expressions.displacement(alone, vertices=len(bind))
            yield bind + moved, partial(_within_reach, bind, np.linalg.norm(moved, axis=1))


def _within_reach(bind: Array, moved: Array, points: Array) -> Array:
    """Which points [n] are no farther from a vertex than the farthest vertex moves, of those that move that far."""
    tree = cKDTree(bind[moved > WELL_MOVED * moved.max()])
    return np.asarray(tree.query(points, distance_upper_bound=float(moved.max()))[0] < np.inf)


def _poses(character: Character, rng: np.random.Generator) -> list[Array]:
    """Local rotations [J, 4] of the bind pose and of random ones."""
    bind = character.skeleton.bind_rotations
    moving = moving_joints(character)[:, None]
    axes = rng.standard_normal((POSES, len(bind), 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    turns = rotation.from_axis_angle(axes, np.where(moving, rng.uniform(0, TURN, (POSES, len(bind), 1)), 0)[..., 0])
    return [bind, *rotation.multiply(np.broadcast_to(bind, turns.shape), turns)]


class _Covers:
    """The surface that hides what is behind it, where its texture is opaque."""

    def __init__(
        self,
        character: Character,
        *,
        cut: Array,  # [F] bool: faces with texels that something shows through
    ) -> None:
        mesh = character.mesh
        self._cut = mesh.faces[cut]
        self._uv = wp.array(mesh.uv[mesh.uv_faces[cut]].reshape(-1, 2), dtype=wp.vec2, device=DEVICE)
        self._shown = wp.array(character.base_color[..., 3] >= SOLID * 255, dtype=bool, device=DEVICE)
        self._tree = Tree(mesh.vertices, mesh.faces[~cut])  # what moves needs no other order of triangles

    def seen(self, points: Array, vertices: Array, *, away: Array, lift: float) -> Array:
        """Which points [n] are not covered from all sides while the surface is at `vertices` [V, 3]."""
        if not len(points):
            return np.empty(0, bool)
        cut = _mesh(vertices, self._cut)
        surface = [self._tree.at(vertices), cut.id, self._uv, self._shown]
        directions = wp.array(away, dtype=wp.vec3, device=DEVICE)

        def looked(some: Array) -> Array:
            seen = wp.zeros(len(some), dtype=bool, device=DEVICE)
            inputs = [
                *surface,
                wp.array(some, dtype=wp.vec3, device=DEVICE),
                directions,
                lift,
            ]
            wp.launch(look_out, dim=len(some), inputs=inputs, outputs=[seen], device=DEVICE)
            return np.asarray(seen.numpy())

        wp.load_module(__name__, device=DEVICE)  # two threads must not do that at once
        threads = min(os.cpu_count() or 1, len(points))
        return np.concatenate(list(in_order(looked, np.array_split(points, threads), threads=threads)))


def _mesh(vertices: Array, faces: Array) -> wp.Mesh:
    """Triangles that rays meet; where there are none, a point, which none meets."""
    some = faces if len(faces) else np.zeros((1, 3), int)
    return wp.Mesh(
        points=wp.array(vertices, dtype=wp.vec3, device=DEVICE),
        indices=wp.array(some.ravel(), dtype=int, device=DEVICE),
    )
