"""A character's whole surface in motion: each frame by its own pose, stretch and time."""

from dataclasses import replace

import numpy as np
import pytest
from tube import still, swing, tube

from mua import rotation
from mua.pose.clip import Clip, Stretches
from mua.rig.character import Character
from mua.teachers.simulated import simulated_surface
from mua.teachers.simulated.simulated_surface import SimulatedSurface
from mua.teachers.simulated.simulation import Simulation
from mua.teachers.simulated.skinned_surface import SkinnedSurface

SINGLE = 64 * float(np.finfo(np.float32).eps)  # metres; what is simulated in single precision


def moving(character: Character, rate: float, seconds: float = 0.4) -> Clip:
    """Two metres a second aside, from rest."""
    frames = round(seconds * rate) + 1
    clip = still(character, frames=frames)
    translations = clip.translations.copy()
    translations[:, 0, 0] += 2 * np.arange(frames) / rate
    return replace(clip, rate=rate, translations=translations)


def bent(character: Character) -> Clip:
    clip = still(character, frames=2)
    rotations = clip.rotations.copy()
    rotations[:, 1] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(100))
    return replace(clip, rotations=rotations)


def test_what_swings_does_so_at_the_pace_of_the_clip() -> None:
    """A motion that is linear in time gives the same at either rate, since both take the same substeps."""
    character = tube(looseness=0.9)
    slow, fast = (list(SimulatedSurface(character).frames(moving(character, rate))) for rate in (30.0, 60.0))
    rigid = list(SkinnedSurface(character).frames(moving(character, 30.0)))
    assert len(fast) == 2 * len(slow) - 1
    for first, second in zip(slow[1:], fast[2::2], strict=True):
        np.testing.assert_allclose(first.places, second.places, rtol=0, atol=50 * SINGLE)
    behind = np.abs(slow[-1].places - rigid[-1].places).max()
    assert behind > 0.01  # it does swing


def test_what_hangs_moves_as_in_a_simulation_of_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only its own part of the surface is simulated; all else is where skinning puts it. Without folds."""
    monkeypatch.setattr(simulated_surface, "Folds", lambda *_, **__: lambda target, turn: target)
    character = tube(rings=57, looseness=0.9)
    upper = character.mesh.vertices[:, 1] > 0.8
    looseness = np.where(upper, 0.9, 0.0)
    character = replace(character, looseness=looseness)
    surface, clip, mesh = SimulatedSurface(character), swing(character), character.mesh
    whole = Simulation(mesh.vertices, mesh.faces, looseness=looseness, bones=surface.bones)
    for frame, (moved, rigid) in enumerate(
        zip(surface.frames(clip), SkinnedSurface(character).frames(clip), strict=True)
    ):
        at = rigid.places, rigid.dual[:, :4], surface.bones.posed(rigid.joints)
        if frame == 0:
            whole.settle(*at)
        expected = whole.advance(*at, seconds=1 / clip.rate)
        np.testing.assert_allclose(moved.places, expected, rtol=0, atol=SINGLE)
    assert np.abs(moved.places - rigid.places)[upper].max() > 0.01


def test_the_seed_chooses_the_folds_alone() -> None:
    character = tube(looseness=1.0)
    shown = [next(iter(SimulatedSurface(character, seed=seed).frames(bent(character)))).places for seed in (0, 0, 1)]
    np.testing.assert_array_equal(shown[0], shown[1])
    apart = np.abs(shown[0] - shown[2]).max()
    assert 1e-4 < apart < 0.1


def test_each_frame_has_the_stretch_of_its_own() -> None:
    character = tube(looseness=0.0)
    clip = still(character, frames=3)
    matrices = np.stack([np.tile(np.diag([1.0 + 0.2 * frame] * 3), (3, 1, 1)) for frame in range(3)])
    stretched = replace(clip, stretches=Stretches(np.arange(3), matrices))
    surface = SkinnedSurface(character)
    for frame, moved in enumerate(surface.frames(stretched)):
        alone = replace(stretched.cut(np.array([frame])), stretches=Stretches(np.arange(3), matrices[[frame]]))
        (expected,) = surface.frames(alone)
        np.testing.assert_array_equal(moved.places, expected.places)
    assert not np.allclose(moved.places, character.mesh.vertices)
