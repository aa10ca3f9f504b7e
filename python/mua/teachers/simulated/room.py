"""Where a surface has room beneath it, as skirts, coats, capes and wide sleeves have: there it hangs.

Lines go inward from each triangle. Through skin, and clothes that lie on it, a line runs through the body until it
meets the far wall from within. Elsewhere it leaves a thin sheet, meets the outside of something farther off, such as
a leg below a skirt, the other side of a skirt about both legs, or nothing. Of clothes with two sides, a thin sheet that
lies on a body is passed, and a thick hem that stands off a leg is none.
"""

# mypy: disable-error-code="index, operator, arg-type, attr-defined, no-untyped-def, var-annotated"
# (the bodies of the kernel and its functions are Warp's language, not Python)

import numpy as np
import warp as wp

from mua.arrays import Array
from mua.rig.bones import figure_scale
from mua.teachers.simulated.smoothing import low_pass
from mua.training.warp_start import start

DEVICE = "cpu"
LINES = 6  # from each triangle; with 96, looseness differs by 0.05 at most
SPREAD = np.radians(40)  # of the lines about straight inward, at most
GOLDEN = np.pi * (3 - 5**0.5)  # from one line to the next, about straight inward: they spread evenly
CLOSE = 0.015  # metres on a person between clothes and what they lie on
THIN = 0.01  # metres on a person: a sheet, not a limb
HEM = 0.06  # metres on a person: no leg is as thin, but a skirt with its lining is
LAYERS = wp.constant(6)  # of clothes that lie on each other, both sides counted
LIFT = 5e-4  # metres on a person, from which a line starts: what lies closer is the surface itself
BOTH = wp.constant(3)  # legs: the left is 1, the right 2
FAR = wp.constant(1.0e6)  # metres
EVEN = 0.2  # metres on a person: room that is shorter than half of this is a gap in a body

start()


@wp.func
def leg_beyond_air(
    surface: wp.uint64, start: wp.vec3, away: wp.vec3, leg: int, legs: wp.array[int], close: float
) -> bool:
    """Whether a line crosses air and then meets the outside of what the same leg moves."""
    hit = wp.mesh_query_ray(surface, start, away, FAR)
    return hit.result and hit.t > close and wp.dot(hit.normal, away) < 0.0 and (legs[hit.face] & leg) != 0


@wp.func
def through_body(
    surface: wp.uint64,
    place: wp.vec3,
    away: wp.vec3,
    leg: int,
    legs: wp.array[int],
    lift: float,
    close: float,
    thin: float,
    hem: float,
) -> bool:
    """Whether a line inward from a place on the surface runs through a body, beneath what lies on it."""
    behind = place - lift * away
    start = place + lift * away
    entered, left = wp.int32(1), wp.int32(0)
    while entered + left <= LAYERS:
        hit = wp.mesh_query_ray(surface, start, away, FAR)
        leaves = hit.result and wp.dot(hit.normal, away) > 0.0
        beyond = start + (hit.t + lift) * away
        if leaves and hit.t > thin:
            if (leg | legs[hit.face]) == BOTH:
                return False
            if leg == 0 or hit.t > hem:
                return True
            return not (
                leg_beyond_air(surface, beyond, away, leg, legs, close)
                or leg_beyond_air(surface, behind, -away, leg, legs, close)
            )
        in_air = not hit.result or (not leaves and hit.t > close)
        if in_air:  # unless it left a sheet that lies on a body, or is sunk into it
            return left > 0 and (entered > left or wp.mesh_query_ray(surface, behind, -away, close).result)
        if leaves:
            left += 1
        else:
            entered += 1
        if left > entered:  # it began within a body
            return True
        start = beyond
    return False


@wp.kernel(enable_backward=False)
def look_in(
    surface: wp.uint64,
    points: wp.array[wp.vec3],
    inward: wp.array2d[wp.vec3],
    legs: wp.array[int],
    lift: float,
    close: float,
    thin: float,
    hem: float,
    body: wp.array[float],
):
    """The share of the lines from each point that run through a body."""
    i = wp.tid()
    found = wp.float32(0.0)
    for k in range(inward.shape[1]):
        if through_body(surface, points[i], inward[i, k], legs[i], legs, lift, close, thin, hem):
            found += 1.0
    body[i] = found / float(inward.shape[1])


def room_beneath(
    vertices: Array,  # [V, 3]
    faces: Array,  # [F, 3]
    *,
    legs: Array,  # [F] which legs move it: 0, the left 1, the right 2, or 3
) -> Array:
    """How much room [V] the surface has beneath it, from 0 (a body) to 1."""
    scale = figure_scale(vertices)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    inward = -normals / np.maximum(areas, np.finfo(float).tiny)[:, None]
    body = _through_bodies(corners.mean(axis=1), vertices, faces, legs, inward=inward, scale=scale)
    total, known = (
        np.bincount(faces.ravel(), np.repeat(values, 3), len(vertices)) for values in ((1 - body) * areas, areas)
    )
    room = low_pass(vertices, faces, EVEN * scale)(total / np.maximum(known, np.finfo(float).tiny))
    return np.asarray(np.clip(room, 0, 1))


def _through_bodies(points: Array, vertices: Array, faces: Array, legs: Array, *, inward: Array, scale: float) -> Array:
    """The share [F] of the lines from each triangle that run through a body."""
    turn = np.random.default_rng(0).uniform(0, 2 * np.pi, (len(faces), 1)) + GOLDEN * np.arange(LINES)
    along = vertices[faces[:, 1]] - vertices[faces[:, 0]]
    along /= np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), np.finfo(float).tiny)
    sideways = np.cos(turn)[..., None] * along[:, None] + np.sin(turn)[..., None] * np.cross(inward, along)[:, None]
    lean = SPREAD * np.sqrt(np.arange(LINES) / LINES)[:, None]
    lines = np.cos(lean) * inward[:, None] + np.sin(lean) * sideways
    mesh = wp.Mesh(
        points=wp.array(vertices, dtype=wp.vec3, device=DEVICE),
        indices=wp.array(faces.ravel(), dtype=int, device=DEVICE),
    )
    body = wp.zeros(len(faces), dtype=float, device=DEVICE)
    places, away = (wp.array(values, dtype=wp.vec3, device=DEVICE) for values in (points, lines))
    inputs = [mesh.id, places, away, wp.array(legs, dtype=int, device=DEVICE)]
    lengths = [scale * length for length in (LIFT, CLOSE, THIN, HEM)]
    wp.launch(look_in, dim=len(faces), inputs=[*inputs, *lengths], outputs=[body], device=DEVICE)
    return np.asarray(body.numpy(), dtype=np.float64)
