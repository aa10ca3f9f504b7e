"""Atlases of real characters, laid out in every way that is tried."""

import numpy as np
import pytest
from shared_data import SharedData

from mua.atlas.uv import build_atlas
from mua.characters.read import read_surfaces
from mua.rig.texel_map import build_texel_map


def test_real_character_gets_an_atlas_of_few_charts_without_overlap(shared_data: SharedData) -> None:
    surfaces = read_surfaces(shared_data.path("characters/White_F_3_Casual.glb"))
    character = build_atlas(surfaces, uv="auto", size=256)
    texels = build_texel_map(character.mesh, 384)
    assert texels.claimed_twice < 0.002 * len(texels.texels)
    assert len(texels.texels) > 0.6 * 384**2
    assert "triangles overlap, are distorted or have next to no texels" in character.notes[-1]


@pytest.mark.parametrize("name", ["lumberjack", "Fox"])
def test_keep_leaves_real_characters_without_overlap_as_they_are(shared_data: SharedData, name: str) -> None:
    surfaces = read_surfaces(shared_data.path(f"characters/{name}.glb"))
    character = build_atlas(surfaces, uv="keep", size=256)
    assert character.base_color is surfaces.materials[0].image
    assert np.array_equal(character.mesh.uv[character.mesh.uv_faces], surfaces.uv[surfaces.uv_faces])


@pytest.mark.parametrize("name", ["lumberjack", "Fox"])
def test_real_characters_have_more_texels_than_in_their_own_layout(shared_data: SharedData, name: str) -> None:
    surfaces = read_surfaces(shared_data.path(f"characters/{name}.glb"))
    own, packed = (build_texel_map(build_atlas(surfaces, uv=uv, size=256).mesh, 384) for uv in ("keep", "auto"))
    assert len(packed.texels) > 1.05 * len(own.texels)
    assert packed.claimed_twice <= own.claimed_twice
