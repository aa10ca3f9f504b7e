"""Colours that surfels show as a picture, held against pictures composited surfel by surfel."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.texture.deconvolution import AROUND, DAMPING, DIRECTIONS, POINTS, blending, deconvolved
from mua.texture.surfels import SPREAD

SIZE, OPACITY = 12, 0.99
EIGHT_BITS = 1 / 255


def striped(fineness: int) -> Array:
    """A picture four times as fine as the texels, with slanting stripes of several widths and a grey ramp."""
    row, column = np.indices((4 * SIZE, 4 * SIZE))
    stripes = (row + 2 * column) // fineness % 2
    return np.stack([60 + 130 * stripes, 190 - 130 * stripes, 100 + row, np.full_like(row, 255)], axis=2).astype(
        np.uint8
    )


def shown(colors: Array, place: tuple[float, float], angle: float) -> Array:
    """The colour [3] at a place (u, v in texels) of surfels in a periodic texture, laid over each other one by one."""
    near = [(v, u) for v in range(-4, SIZE + 4) for u in range(-4, SIZE + 4)]
    near.sort(key=lambda at: at[1] * np.cos(angle) + at[0] * np.sin(angle))  # from far to near
    color, alpha = np.zeros(3), 0.0
    for v, u in near:
        square = (u + 0.5 - place[0]) ** 2 + (v + 0.5 - place[1]) ** 2
        if max(abs(u + 0.5 - place[0]), abs(v + 0.5 - place[1])) > AROUND + 0.5:
            continue
        hides = OPACITY * np.exp(-square / (2 * SPREAD**2))
        color, alpha = color * (1 - hides) + hides * colors[v % SIZE, u % SIZE], alpha * (1 - hides) + hides
    return color / alpha


def test_weights_are_those_of_surfels_laid_over_each_other() -> None:
    place = np.array([0.25, -0.25])
    single = np.eye(SIZE * SIZE)[5 * SIZE + 6].reshape(SIZE, SIZE, 1) * np.ones(3)  # one white texel
    for row, weights in enumerate(blending(place, OPACITY)):
        angle = (row + 0.5) * 2 * np.pi / DIRECTIONS
        for dv in (-1, 0, 1):
            for du in (-1, 0, 1):
                at = (6 - du + 0.5 + place[0], 5 - dv + 0.5 + place[1])
                assert weights[AROUND + dv, AROUND + du] == pytest.approx(shown(single, at, angle)[0], abs=1e-12)


def test_it_is_the_least_squares_solution() -> None:
    base_color = striped(3)
    rows, wanted = [], []
    picture = base_color[..., :3].reshape(SIZE * POINTS, 2, SIZE * POINTS, 2, 3).mean(axis=(1, 3)) / 255
    for v, u, y, x in np.ndindex(SIZE, SIZE, POINTS, POINTS):
        for weights in blending((np.array([x, y]) + 0.5) / POINTS - 0.5, OPACITY):
            row = np.zeros((SIZE, SIZE))
            for dv, du in np.ndindex(weights.shape):
                row[(v + dv - AROUND) % SIZE, (u + du - AROUND) % SIZE] += weights[dv, du]
            rows.append(row.ravel())
            wanted.append(picture[v * POINTS + y, u * POINTS + x])
    own = picture.reshape(SIZE, POINTS, SIZE, POINTS, 3).mean(axis=(1, 3)).reshape(-1, 3)
    weight = DAMPING * np.sqrt(POINTS**2 * DIRECTIONS)
    system = np.concatenate([np.stack(rows), weight * np.eye(SIZE * SIZE)])
    solution = np.linalg.lstsq(system, np.concatenate([np.stack(wanted), weight * own]), rcond=None)[0]
    expected = np.clip(solution, 0, 1).reshape(SIZE, SIZE, 3)
    np.testing.assert_allclose(deconvolved(base_color, SIZE, OPACITY), expected, atol=EIGHT_BITS)


def test_stripes_come_out_nearer_to_the_picture_than_averages_of_it() -> None:
    base_color = striped(12)
    averaged = base_color[..., :3].reshape(SIZE, 4, SIZE, 4, 3).mean(axis=(1, 3)) / 255
    fitted = deconvolved(base_color, SIZE, OPACITY)
    errors = {"averaged": 0.0, "fitted": 0.0}
    rng = np.random.default_rng(0)
    for u, v in rng.uniform(0, SIZE, (150, 2)):
        there = base_color[int(4 * v), int(4 * u), :3] / 255
        angle = rng.uniform(0, 2 * np.pi)
        for name, colors in (("averaged", averaged), ("fitted", fitted)):
            errors[name] += float(((shown(colors, (u, v), angle) - there) ** 2).sum())
    assert errors["fitted"] < 0.96 * errors["averaged"]


def test_an_even_picture_stays_as_it_is() -> None:
    base_color = np.full((24, 24, 4), 200, np.uint8)
    np.testing.assert_allclose(deconvolved(base_color, SIZE, OPACITY), 200 / 255, atol=1e-6)
