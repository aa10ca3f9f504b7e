"""Print how near whole characters come to their source, as laid and fitted, in the poses and views of a check.

python tools/research/compare_fitted.py hero.glb witch.vrm --texels 384 --steps 80 [--motion walk.bvh]

Decibels of the worst pose and of all poses together, and the overlap of the silhouettes in its worst pose. A check
(`mua-bake --check`) shows splats as they are laid; a bake fits them. Motion that a character cannot follow is left out.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from mua.atlas.detail import read_detail
from mua.baking.sources import load_character
from mua.fidelity import fitting
from mua.fidelity.compare import Fidelity, compare
from mua.fidelity.measure import together
from mua.motion.load import load_motions
from mua.motion.range import motion_range
from mua.pose.encoding import RATE
from mua.teachers.simulated.still import StillTeacher


def figures(found: Fidelity) -> str:
    """One line."""
    mean = together([shot.agreement for pose in found.poses for shot in pose.shots])
    return f"{found.psnr:.2f} dB in the worst pose, {mean.psnr:.2f} in all, {found.iou:.1%} overlap"


def compared(path: Path, motion: Sequence[Path], *, texels: int, steps: int) -> tuple[Fidelity, Fidelity]:
    """As laid and fitted, on this motion or the character's own."""
    character = replace(load_character(path, uv="auto", seed=0, detail=read_detail((), uv="auto")), expressions=None)
    if character.source is None:
        raise SystemExit(f"{path}: this format keeps nothing to compare with")
    roles = character.roles
    loaded = [
        one for file in motion for one in load_motions(file, character.skeleton, mapping=None, rate=RATE, roles=roles)
    ]
    clips = [one.clip for one in loaded] or list(character.clips)
    laid = StillTeacher(character, texels=texels)
    fitted_on = clips or motion_range(character, (), frames=fitting.POSES, seed=0, short=True)
    by = fitting.fit(character, fitted_on, teacher=laid, source=character.source, steps=steps)
    first, second = (
        compare(character, clips, teacher=teacher, source=character.source) for teacher in (laid, laid.corrected(by))
    )
    return first, second


def main(arguments: list[str] | None = None) -> None:
    """Print two lines for each character."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("characters", type=Path, nargs="+")
    parser.add_argument("--texels", type=int, default=384)
    parser.add_argument("--steps", type=int, default=80, help="of the fit to the source: a third of a bake's --frames")
    parser.add_argument("--motion", type=Path, nargs="+", default=[], help="motion files to pose the characters by")
    options = parser.parse_args(arguments)
    for path in options.characters:
        laid, fitted = compared(path, options.motion, texels=options.texels, steps=options.steps)
        print(f"{path.stem}, laid: {figures(laid)}\n{path.stem}, fitted: {figures(fitted)}", flush=True)


if __name__ == "__main__":
    main()
