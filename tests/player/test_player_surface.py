"""The player draws the triangles that a file holds, and knows those about each texel."""

from dataclasses import replace

import numpy as np
from synthetic_avatar import synthetic_avatar, with_surface

from mua.asset.avatar import Avatar
from mua.asset.read import decode_tree, parse_checked
from mua.asset.write import encode
from mua.player.surface import surface_mesh


def reread(avatar: Avatar) -> Avatar:
    return decode_tree(parse_checked(encode(avatar)))


def test_lists_every_triangle_about_each_of_its_corners() -> None:
    surface = surface_mesh(with_surface(synthetic_avatar()))
    owner = np.repeat(np.arange(len(surface.ring_starts) - 1), surface.ring_starts[1:] - surface.ring_starts[:-1])
    about = np.column_stack([owner, surface.ring])
    turned = np.concatenate([np.roll(surface.triangles, -k, axis=1) for k in range(3)])
    np.testing.assert_array_equal(np.unique(about, axis=0), np.unique(turned, axis=0))
    assert len(about) == len(turned)


def test_draws_what_the_file_holds() -> None:
    avatar = with_surface(synthetic_avatar())
    assert avatar.surface
    seamless = replace(avatar, surface=replace(avatar.surface, strips=avatar.surface.strips[:0]))
    whole, open_ = (surface_mesh(reread(each)).triangles for each in (avatar, seamless))
    assert 0 < len(open_) < len(whole)
    np.testing.assert_array_equal(open_, whole[: len(open_)])


def test_triangulates_a_file_that_holds_no_surface() -> None:
    bare = reread(synthetic_avatar())
    assert bare.surface is None
    expected = surface_mesh(reread(with_surface(bare)))
    np.testing.assert_array_equal(surface_mesh(bare).triangles, expected.triangles)
