"""Colours that surfels show as an image, held against images composited surfel by surfel."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.texture.albedo import FINER, finer_picture
from mua.texture.deconvolution import AROUND, DAMPING, DIRECTIONS, LEVELS, blending, deconvolved
from mua.texture.sharpness import SPREAD

SIZE, OPACITY = 12, 0.99
ALIKE = np.full((SIZE, SIZE), SPREAD)
EIGHT_BITS = 1 / 255


def striped(fineness: int) -> Array:
    """An image four times as fine as the texels, with slanting stripes of several widths and a grey ramp."""
    row, column = np.indices((4 * SIZE, 4 * SIZE))
    stripes = (row + 2 * column) // fineness % 2
    return np.stack([60 + 130 * stripes, 190 - 130 * stripes, 100 + row, np.full_like(row, 255)], axis=2).astype(
        np.uint8
    )


def fitted_to(base_color: Array, spreads: Array = ALIKE) -> Array:
    return deconvolved(finer_picture(base_color, SIZE)[..., :3], OPACITY, spreads)


def shown(colors: Array, place: tuple[float, float], angle: float, spread: float = SPREAD) -> Array:
    """The colour [3] at a place (u, v in texels) of surfels in a periodic texture, laid over each other one by one."""
    near = [(v, u) for v in range(-4, SIZE + 4) for u in range(-4, SIZE + 4)]
    near.sort(key=lambda at: at[1] * np.cos(angle) + at[0] * np.sin(angle))  # from far to near
    color, alpha = np.zeros(3), 0.0
    for v, u in near:
        square = (u + 0.5 - place[0]) ** 2 + (v + 0.5 - place[1]) ** 2
        if max(abs(u + 0.5 - place[0]), abs(v + 0.5 - place[1])) > AROUND + 0.5:
            continue
        hides = OPACITY * np.exp(-square / (2 * spread**2))
        color, alpha = color * (1 - hides) + hides * colors[v % SIZE, u % SIZE], alpha * (1 - hides) + hides
    return color / alpha


def test_weights_are_those_of_surfels_laid_over_each_other() -> None:
    place = np.array([0.25, -0.25])
    single = np.eye(SIZE * SIZE)[5 * SIZE + 6].reshape(SIZE, SIZE, 1) * np.ones(3)  # one white texel
    assert len(blending(place, OPACITY, SPREAD)) == DIRECTIONS
    for row, weights in enumerate(blending(place, OPACITY, SPREAD)):
        angle = (row + 0.5) * 2 * np.pi / DIRECTIONS
        for dv in (-1, 0, 1):
            for du in (-1, 0, 1):
                at = (6 - du + 0.5 + place[0], 5 - dv + 0.5 + place[1])
                assert weights[AROUND + dv, AROUND + du] == pytest.approx(shown(single, at, angle)[0], abs=1e-12)


def test_it_is_the_least_squares_solution() -> None:
    base_color = striped(3)
    rows, wanted = [], []
    picture = base_color[..., :3].reshape(SIZE * FINER, 2, SIZE * FINER, 2, 3).mean(axis=(1, 3)) / 255
    for v, u, y, x in np.ndindex(SIZE, SIZE, FINER, FINER):
        for weights in blending((np.array([x, y]) + 0.5) / FINER - 0.5, OPACITY, SPREAD):
            row = np.zeros((SIZE, SIZE))
            for dv, du in np.ndindex(weights.shape):
                row[(v + dv - AROUND) % SIZE, (u + du - AROUND) % SIZE] += weights[dv, du]
            rows.append(row.ravel())
            wanted.append(picture[v * FINER + y, u * FINER + x])
    own = picture.reshape(SIZE, FINER, SIZE, FINER, 3).mean(axis=(1, 3)).reshape(-1, 3)
    weight = DAMPING * np.sqrt(FINER**2 * DIRECTIONS)
    system = np.concatenate([np.stack(rows), weight * np.eye(SIZE * SIZE)])
    solution = np.linalg.lstsq(system, np.concatenate([np.stack(wanted), weight * own]), rcond=None)[0]
    expected = np.clip(solution, 0, 1).reshape(SIZE, SIZE, 3)
    np.testing.assert_allclose(fitted_to(base_color), expected, atol=EIGHT_BITS)


def test_stripes_come_out_nearer_to_the_picture_than_averages_of_it() -> None:
    base_color = striped(12)
    averaged = base_color[..., :3].reshape(SIZE, 4, SIZE, 4, 3).mean(axis=(1, 3)) / 255
    fitted = fitted_to(base_color)
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
    np.testing.assert_allclose(fitted_to(base_color), 200 / 255, atol=1e-6)


def test_texels_take_the_colours_of_their_own_width() -> None:
    """Wide surfels on the left and narrow ones on the right, with a width between them that is no level."""
    base_color = striped(3)
    narrow, wide = 0.5, 0.7
    spreads = np.full((SIZE, SIZE), narrow)
    spreads[:, : SIZE // 3] = wide
    spreads[:, SIZE // 3] = between = narrow + 0.25 * (wide - narrow) / (LEVELS - 1)
    found = fitted_to(base_color, spreads)
    levels = {width: fitted_to(base_color, np.full_like(spreads, width)) for width in np.linspace(narrow, wide, LEVELS)}
    np.testing.assert_array_equal(found[:, : SIZE // 3], levels[wide][:, : SIZE // 3])
    np.testing.assert_array_equal(found[:, SIZE // 3 + 1 :], levels[narrow][:, SIZE // 3 + 1 :])
    lower, upper = list(levels.values())[:2]
    assert between not in levels
    np.testing.assert_allclose(found[:, SIZE // 3], (0.75 * lower + 0.25 * upper)[:, SIZE // 3], atol=1e-6)


def test_colours_of_a_hard_edge_are_colours() -> None:
    """The least-squares solution alone would overshoot on both sides."""
    edge = np.full((4 * SIZE, 4 * SIZE, 4), 255, np.uint8)
    edge[:, : 2 * SIZE, :3] = 0
    found = fitted_to(edge)
    assert (found.min(), found.max()) == (0, 1)
