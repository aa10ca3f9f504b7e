"""Print how far the simulation stands off the skinned surface, in mm on a person of 1.75 m, by body part.

python tools/research/measure_sag.py hero.glb other.glb --motion jumping.bvh

Of each vertex the larger of two frames, the middle and the last of the most active seconds; over the corners of the
triangles of a part, half, nine tenths and all lie nearer than the three figures.
"""

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from unseen_teacher import motions_of

from mua.arrays import Array
from mua.atlas.detail import read_detail
from mua.baking.sources import load_character
from mua.pose.clip import Clip
from mua.rig.body_parts import BODY_PARTS, body_parts
from mua.rig.bones import figure_scale
from mua.rig.character import Character
from mua.teachers.simulated.simulated_surface import SimulatedSurface
from mua.teachers.simulated.surface import SkinnedSurface

QUANTILES = (0.5, 0.9, 1.0)


def distances(character: Character, clip: Clip) -> Iterator[Array]:
    """Metres [V] between the simulated and the skinned surface in the frames that count."""
    skinned, wanted = SkinnedSurface(character), {len(clip) // 2, len(clip) - 1}
    for frame, moved in enumerate(SimulatedSurface(character).frames(clip)):
        if frame in wanted:
            yield np.linalg.norm(moved.places - skinned.posed(moved.joints).places, axis=1)


def measure(path: Path, motion: Sequence[Path]) -> None:
    """Print a line for each body part of a character."""
    # The atlas does not matter here.
    character = load_character(path, uv="keep", seed=0, detail=read_detail((), uv="keep"))
    faces, scale = character.mesh.faces, figure_scale(character.mesh.vertices)
    part = body_parts(character.skeleton, faces, character.skin_indices, character.skin_weights, stated=character.roles)
    sag = np.max([one for moved in motions_of(character, motion) for one in distances(character, moved.clip)], axis=0)
    for number, name in enumerate(BODY_PARTS):
        if (own := part == number).any():
            figures = 1000 / scale * np.quantile(sag[faces[own]], QUANTILES)
            print(f"{path.stem}, {name}: " + ", ".join(f"{mm:.1f}" for mm in figures) + " mm", flush=True)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure each character."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("characters", type=Path, nargs="+")
    parser.add_argument("--motion", type=Path, nargs="+", required=True)
    options = parser.parse_args(arguments)
    for path in options.characters:
        measure(path, options.motion)


if __name__ == "__main__":
    main()
