"""Keep the splats that a character's simulated teacher shows as its file stands, for measure_close_ups.py --before.

PYTHONPATH=other_checkout/python python tools/research/still_splats.py hero.glb witch.vrm --texels 256 -o before/

Run it with the package of the commit to compare with: it finds what it needs under the names that modules had there.
"""

import argparse
from dataclasses import fields
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from mua.atlas.detail import read_detail
from mua.baking.sources import load_character

STILL_TEACHER = "mua.teachers.still", "mua.teachers.simulated.still"
DECODE = "mua.decode", "mua.avatar.decode"
POSER = "mua.fidelity.posing", "mua.fidelity.posed_source"


def still_splats(path: Path, *, texels: int) -> dict[str, np.ndarray]:
    """The fields of the splats in the world, less those that are None."""
    character = load_character(path, uv="auto", seed=0, detail=read_detail((), uv="auto"))
    if character.source is None:
        raise SystemExit(f"{path}: this format keeps nothing to compare with")
    rest = _module(POSER).Poser(character.source, character.skeleton).rest()
    teacher = _module(STILL_TEACHER).StillTeacher(character, texels=texels)
    shown = teacher.frame(rest.pose, rest.stretches)
    splats = _module(DECODE).pose_splats(teacher.rig, shown.mesh, texture=shown.texture, pose=rest.pose)
    found = {field.name: getattr(splats, field.name) for field in fields(splats)}
    return {name: value for name, value in found.items() if value is not None}


def _module(names: tuple[str, ...]) -> Any:
    """The first of these modules that there is."""
    return import_module(next(name for name in names if find_spec(name)))


def main(arguments: list[str] | None = None) -> None:
    """Write FOLDER/CHARACTER.npz for each character."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("characters", type=Path, nargs="+")
    parser.add_argument("--texels", type=int, default=256)
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    for path in options.characters:
        kept: dict[str, Any] = still_splats(path, texels=options.texels)
        np.savez(options.output / f"{path.stem}.npz", **kept)


if __name__ == "__main__":
    main()
