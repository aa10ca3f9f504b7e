"""Random texels before two eyes."""

import numpy as np
from projected import FACES, Texels, held, on_steps
from skinned_cases import random_joints

from mua.avatar.camera import Camera, orbit

SCREEN = (97, 61)

BOX = np.array([[-1.0, -1, -1], [1, 1, 1]])


def random_texels(count: int, *, scales: tuple[float, float] = (-5.2, -3.2), logit: float = 7) -> Texels:
    """On FACES, posed up to 1.9 m from the origin; some without a rotation, some on an edge, some too faint to see."""
    rng = np.random.default_rng(count)
    barycentrics = rng.dirichlet([1, 1, 1], count).reshape(count, 3)
    barycentrics[::5, :2], barycentrics[::5, 2] = 0.5, 0
    texture = rng.normal(size=(count, 23))
    texture[:, 0:3] *= 0.05
    texture[::8, 3:7] = 0
    texture[:, 7:10] = rng.uniform(*scales, (count, 3))
    texture[:, 10] = rng.uniform(-logit, logit, count)
    return Texels(
        (random_joints(rng, 6) * rng.choice([-1.0, 1.0], (6, 1))).astype(np.float32),
        rng.uniform(-0.5, 0.5, (6, 3)).astype(np.float32),
        FACES,
        rng.integers(0, len(FACES), count),
        on_steps(barycentrics),
        held(texture),
        rng.random(count) < 0.7,
    )


def stereo(apart: float = 0.2) -> tuple[Camera, Camera]:
    """Two eyes beside each other, canted, whose projections are skewed."""
    eyes = []
    for side in (-1, 1):
        middle = orbit(BOX, screen=SCREEN, azimuth=0.7 + 0.1 * side, elevation=0.4)
        view, projection = middle.view.copy(), middle.projection.copy()
        view[:3, 3] -= [side * apart / 2, 0, side * apart / 4]
        projection[0, 2] = -0.3 * side
        eyes.append(Camera(view, projection, SCREEN))
    return eyes[0], eyes[1]
