"""What texels show that no view can reach: teeth behind lips that no joint opens, skin in a shoe, pages under a cover.

Their splats shine through what lies close above them, since splats are sorted by their centres alone, and fill the gaps
of coarse ones. They show the colour of what is seen instead.
"""

# mypy: disable-error-code="index, operator, attr-defined, no-untyped-def, var-annotated"
# (the body of the kernel is Warp's language, not Python)

import numpy as np
import warp as wp
from scipy.spatial import cKDTree

from mua import rotation
from mua.arrays import Array
from mua.rig.character import Character
from mua.rig.moving import moving_joints
from mua.teachers.simulated.surface import SkinnedSurface
from mua.training.warp_start import start

DEVICE = "cpu"
DIRECTIONS = 48  # in which a point looks out, others in each pose
POSES = 8  # in which joints are turned at random, beside the bind pose
TURN = np.radians(120)  # of a joint, at most
LIFT = 5e-4  # metres on a person, from which a ray starts: what lies closer is the surface itself

start()


@wp.kernel(enable_backward=False)
def look_out(
    mesh: wp.uint64,
    points: wp.array[wp.vec3],
    directions: wp.array[wp.vec3],
    lift: float,
    seen: wp.array[wp.bool],
):
    """Whether a ray from each point meets no triangle."""
    i = wp.tid()
    for k in range(directions.shape[0]):
        if not seen[i]:
            away = directions[k]
            seen[i] = not wp.mesh_query_ray_anyhit(mesh, points[i] + lift * away, away, 1.0e6)


def showing_instead(
    character: Character,
    corners: Array,  # [N, 3] vertices of the triangle of each texel
    barycentrics: Array,  # [N, 3]
    *,
    solid: Array,  # [N] bool: texels that nothing shows through
) -> Array:
    """The texel [N] whose colour each one shows: its own, or that of the nearest solid one that can be seen."""
    surface, skeleton = SkinnedSurface(character), character.skeleton
    clear = np.isin(character.mesh.faces, corners[~solid]).all(axis=1)
    faces = character.mesh.faces[~clear]
    lift = LIFT * float(np.ptp(character.mesh.vertices, axis=0).max())
    hidden = np.arange(len(corners))
    rng = np.random.default_rng(0)
    for turned in _poses(character, rng):
        places = surface.posed(skeleton.skinning(turned, skeleton.bind_translations)).places
        points = np.einsum("nk,nkc->nc", barycentrics[hidden], places[corners[hidden]])
        away = rng.standard_normal((DIRECTIONS, 3))
        away /= np.linalg.norm(away, axis=1, keepdims=True)
        hidden = hidden[~_seen(points, places, faces, away=away, lift=lift)]
    shown, own = np.arange(len(corners)), np.ones(len(corners), bool)
    own[hidden] = False
    if len(hidden) and (own & solid).any():
        points = np.einsum("nk,nkc->nc", barycentrics, character.mesh.vertices[corners])
        shown[hidden] = np.flatnonzero(own & solid)[cKDTree(points[own & solid]).query(points[hidden])[1]]
    return shown


def _poses(character: Character, rng: np.random.Generator) -> list[Array]:
    """Local rotations [J, 4] of the bind pose and of random ones."""
    bind = character.skeleton.bind_rotations
    moving = moving_joints(character)[:, None]
    axes = rng.standard_normal((POSES, len(bind), 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    turns = rotation.from_axis_angle(axes, np.where(moving, rng.uniform(0, TURN, (POSES, len(bind), 1)), 0)[..., 0])
    return [bind, *rotation.multiply(np.broadcast_to(bind, turns.shape), turns)]


def _seen(points: Array, vertices: Array, faces: Array, *, away: Array, lift: float) -> Array:
    """Which points [n] a triangle does not enclose from all sides."""
    seen = wp.zeros(len(points), dtype=bool, device=DEVICE)
    if len(points) and len(faces):
        mesh = wp.Mesh(
            points=wp.array(vertices, dtype=wp.vec3, device=DEVICE),
            indices=wp.array(faces.ravel(), dtype=int, device=DEVICE),
        )
        inputs = [wp.array(values, dtype=wp.vec3, device=DEVICE) for values in (points, away)]
        wp.launch(look_out, dim=len(points), inputs=[mesh.id, *inputs, lift], outputs=[seen], device=DEVICE)
    return np.asarray(seen.numpy() | (len(faces) == 0))
