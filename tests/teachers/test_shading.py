"""Light on the simulated surface."""

import numpy as np

from mua import rotation
from mua.teachers.simulated.shading import LAMP, SHADOW, shade, visibility

SINGLE = 32 * float(np.finfo(np.float32).eps)  # some ten operations on values of about 1
STRAIGHT = np.array([1.0, 0, 0, 0])


def visibility_by_definition(
    points: np.ndarray, normals: np.ndarray, ends: np.ndarray, radii: np.ndarray
) -> np.ndarray:
    left = np.ones(len(points))
    for i, (point, normal) in enumerate(zip(points, normals, strict=True)):
        for (start, end), radius in zip(ends, radii, strict=True):
            along = np.linspace(0, 1, 20001)[:, None]
            segment = start + along * (end - start) - point
            towards = segment[np.argmin(np.linalg.norm(segment, axis=1))]
            distance = np.linalg.norm(towards)
            facing = max(normal @ towards / distance, 0)
            left[i] *= 1 - SHADOW * (facing * min(radius / distance, 1)) ** 2
    return left


def test_bones_take_light_by_their_nearest_point() -> None:
    rng = np.random.default_rng(0)
    points, normals = rng.standard_normal((13, 3)), rotation.normalize(rng.standard_normal((13, 3)))
    ends, radii = rng.standard_normal((3, 2, 3)), np.array([0.1, 0.4, 0.7])
    expected = visibility_by_definition(points, normals, ends, radii)
    sampling = 1e-4  # of the segment, above
    np.testing.assert_allclose(visibility(points, normals, ends, radii), expected, atol=sampling + SINGLE)


def test_nothing_is_hidden_without_bones() -> None:
    points, up = np.zeros((3, 3)), np.tile([0.0, 1, 0], (3, 1))
    np.testing.assert_array_equal(visibility(points, up, np.zeros((0, 2, 3)), np.zeros(0)), 1)


def test_light_turns_with_the_body() -> None:
    rng = np.random.default_rng(0)
    normals = rotation.normalize(rng.standard_normal((11, 3)))
    yaw = rotation.from_axis_angle(np.array([0, 1.0, 0]), 2.0)
    front = shade(normals, np.ones(11), heading=STRAIGHT)
    turned = shade(rotation.rotate(yaw, normals), np.ones(11), heading=yaw)
    np.testing.assert_allclose(turned.gain, front.gain, atol=SINGLE)
    np.testing.assert_allclose(turned.sheen, rotation.rotate(yaw, front.sheen), atol=SINGLE)


def test_a_surface_is_brightest_towards_the_lamp_and_where_nothing_hides_it() -> None:
    lamp = LAMP / np.linalg.norm(LAMP)
    light = shade(np.stack([lamp, -lamp, lamp]), np.array([1, 1, 0.5]), heading=STRAIGHT)
    assert np.all(light.gain[0] > light.gain[1])
    assert np.all(light.gain[0] > light.gain[2])
    assert np.all(light.gain > 0)


def test_sheen_is_brightest_in_the_mirrored_direction() -> None:
    rng = np.random.default_rng(0)
    lamp = LAMP / np.linalg.norm(LAMP)
    normal = rotation.normalize(lamp + np.array([0.3, 0.2, 0]))
    sheen = shade(normal[None], np.ones(1), heading=STRAIGHT).sheen[0]
    directions = rotation.normalize(rng.standard_normal((1000, 3)))
    mirrored = 2 * (normal @ lamp) * normal - lamp
    assert sheen @ -mirrored > np.max(directions @ sheen)
