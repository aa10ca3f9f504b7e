"""Light on the simulated surface: a sky, a lamp and the shadow of near limbs, in the frame that the body faces.

The light turns with the body's heading, so that a colour depends on the pose alone and a student that reads
heading-normalised poses can show it. Everything is smooth in normals and distances: the edge of a hard shadow
would be finer than what a student can show.
"""

# mypy: disable-error-code="index, operator, attr-defined, no-untyped-def, var-annotated"
# (the body of the kernel is Warp's language, not Python)

import numpy as np
import warp as wp

from mua import rotation
from mua.arrays import Array
from mua.teacher import Light
from mua.training.warp_start import start

DEVICE = "cpu"
LAMP = np.array([0.35, 0.65, 0.67])  # towards the lamp: from above, front and the body's left
LAMP_COLOR = np.array([0.80, 0.76, 0.70])  # linear light
SKY_COLOR = np.array([0.42, 0.46, 0.52])
GROUND_COLOR = np.array([0.20, 0.18, 0.16])
WRAP = 0.4  # how far the lamp reaches around the terminator: it is large and near
DISPLAY_GAMMA = 2.2  # textures and splat colours are display values
SHADOW = 0.85  # share of the light that a bone hides when it fills the view along the normal
SHEEN = 0.10  # display value at the centre of the lamp's reflection

start()


@wp.kernel(enable_backward=False)
def occlude(
    points: wp.array[wp.vec3],
    normals: wp.array[wp.vec3],
    ends: wp.array2d[wp.vec3],
    radii: wp.array[float],
    shadow: float,
    visible: wp.array[float],
):
    """The share of light left at each point: a capsule takes what a sphere at its nearest point would."""
    i = wp.tid()
    point = points[i]
    left = wp.float32(1.0)
    for c in range(ends.shape[0]):
        start = ends[c, 0]
        axis = ends[c, 1] - start
        along = wp.dot(point - start, axis) / wp.max(wp.dot(axis, axis), 1.0e-12)
        towards = start + axis * wp.clamp(along, 0.0, 1.0) - point
        ahead = wp.dot(normals[i], towards)
        if ahead > 0.0:
            distance = wp.max(wp.length(towards), 1.0e-9)
            facing = ahead / distance
            near = radii[c] / wp.max(distance, radii[c])
            left = left * (1.0 - shadow * facing * facing * near * near)
    visible[i] = left


def visibility(
    points: Array,  # [V, 3] world
    normals: Array,  # [V, 3] unit, world
    ends: Array,  # [C, 2, 3] capsules, world
    radii: Array,  # [C]
) -> Array:
    """The share of light [V] float64 in 0..1 that the capsules leave at points of a surface."""
    result = wp.empty(len(points), dtype=float, device=DEVICE)
    vectors = [wp.array(values, dtype=wp.vec3, device=DEVICE) for values in (points, normals)]
    capsules = wp.array(ends, dtype=wp.vec3, ndim=2, device=DEVICE), wp.array(radii, dtype=float, device=DEVICE)
    wp.launch(occlude, dim=len(points), inputs=[*vectors, *capsules, SHADOW], outputs=[result], device=DEVICE)
    return np.asarray(result.numpy(), dtype=np.float64)


def shade(
    normals: Array,  # [V, 3] unit, world
    visible: Array,  # [V] share of light
    *,
    heading: Array,  # [4] the body's yaw, unit quaternion
) -> Light:
    """Light a matt surface with a little sheen, which is linear in the view direction: degree-1 SH can hold it."""
    lamp = rotation.rotate(heading, LAMP / np.linalg.norm(LAMP))
    slant = normals @ lamp
    lit = np.maximum((slant + WRAP) / (1 + WRAP), 0) ** 2
    upward = 0.5 + 0.5 * normals[:, 1]
    sky = GROUND_COLOR + (SKY_COLOR - GROUND_COLOR) * upward[:, None]
    light = visible[:, None] * (sky + LAMP_COLOR * lit[:, None])
    mirrored = 2 * slant[:, None] * normals - lamp  # seen brightest when looking against it
    gain = light.astype(np.float32) ** np.float32(1 / DISPLAY_GAMMA)  # several times as fast as in double precision
    return Light(gain=gain, sheen=-SHEEN * (visible * lit)[:, None] * mirrored)
