"""Print what each attribute costs in unseen motion: a student's images with that attribute of its teacher.

python tools/research/swap_attributes.py hero.glb hero.muaavatar --fit hero.work/fit-*.npy --motion kicks/*.bvh

Two frames of each motion, of head, hand, the height with most open borders and the whole figure, from the front and
from behind. The teacher is the simulated one, with its light and its moving cloth, and all images are compared with its
own. With the teacher's mesh, a part that swings elsewhere does not hide what frays: "dark" is measured beyond its
silhouette (measure_close_ups.py). Several avatars of one character are compared in one run.
"""

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from measure_close_ups import GREY, SIDES, Figures, measured, parts_of
from PIL import Image
from unseen_teacher import Motion, Shown, Teacher, motions_of

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import Splats, decode_clip_frame, pose_splats
from mua.channels import ATTRIBUTES
from mua.fidelity.background import over
from mua.fidelity.canvas import opened
from mua.fidelity.posed_source import Poser
from mua.fidelity.splats import SplatPainter
from mua.teachers.simulated.surface import SkinnedSurface

FRAMES = 2  # of a motion
TEACHER = "teacher"


def variants(avatars: dict[str, Avatar], motion: Motion, shown: Shown, *, each: bool) -> Iterator[tuple[str, Splats]]:
    """The teacher; every student on its own mesh and on the teacher's; with `each`, attributes of one in the other."""
    pose = motion.clip.pose(shown.frame)
    rig = next(iter(avatars.values())).rig
    yield TEACHER, pose_splats(rig, shown.mesh, texture=shown.texture, pose=pose)
    for name, avatar in avatars.items():
        student = decode_clip_frame(avatar, motion.clip, frame=shown.frame)
        yield name, student
        yield f"{name}, teacher's mesh", pose_splats(rig, shown.mesh, texture=student.texture, pose=pose)
        for attribute, channels in ATTRIBUTES.items() if each else ():
            one, other = student.texture.copy(), shown.texture.copy()
            one[:, channels], other[:, channels] = shown.texture[:, channels], student.texture[:, channels]
            yield f"{name}, teacher's {attribute}", pose_splats(rig, student.canonical, texture=one, pose=pose)
            yield f"{TEACHER}, {attribute} of {name}", pose_splats(rig, shown.mesh, texture=other, pose=pose)
        if each:
            yield f"{TEACHER}, mesh of {name}", pose_splats(rig, student.canonical, texture=shown.texture, pose=pose)


def views(teacher: Teacher, motion: Motion, frame: int, *, size: int) -> Iterator[tuple[str, Camera, float]]:
    """The part that each camera looks at, and how many pixels a metre is long there."""
    character = teacher.character
    assert character.source is not None
    moment = Poser(character.source, character.skeleton).of_clip(motion.clip, frame)
    joints = character.skeleton.skinning(moment.pose.rotations, moment.pose.translations)
    places = SkinnedSurface(character).posed(joints, moment.stretches).places
    for part, box in (*parts_of(character, places), ("whole", np.stack([places.min(axis=0), places.max(axis=0)]))):
        for degrees in SIDES.values():
            camera = orbit(box, screen=(size, size), azimuth=moment.yaw + float(np.radians(degrees)))
            away = -(camera.view @ np.append(box.mean(axis=0), 1))[2]
            yield part, camera, float(camera.projection[1, 1] * size / 2 / away)


def compared(
    teacher: Teacher, avatars: dict[str, Avatar], motions: Sequence[Motion], *, size: int, each: bool
) -> Iterator[tuple[str, str, dict[str, Figures], list[Array]]]:
    """The motion and frame, the part, figures of every variant, and the images [size, size, 3] of whole students."""
    reference = np.ones((len(next(iter(avatars.values())).rig.texels.texels), 23), np.float32)
    nowhere = np.zeros((size, size), bool)
    with opened() as context:
        paint = SplatPainter(context, (size, size))
        for motion in motions:
            frames = motion.frames[np.linspace(len(motion.frames) // 3, len(motion.frames) - 1, FRAMES).astype(int)]
            for shown in teacher.shown(motion, reference):
                if shown.frame not in frames:
                    continue
                posed = dict(variants(avatars, motion, shown, each=each))
                for part, camera, scale in views(teacher, motion, shown.frame, size=size):
                    images = {name: paint(splats, camera) for name, splats in posed.items()}
                    true = images[TEACHER]
                    figures = {name: measured(true, image, nowhere, scale=scale) for name, image in images.items()}
                    drawn = [over(images[name], GREY) for name in (TEACHER, *avatars)]
                    yield f"{motion.clip.name} {shown.frame}", part, figures, drawn


def main() -> None:
    """Print the means over all frames and views of each part."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("character", type=Path)
    parser.add_argument("avatars", type=Path, nargs="+", help="baked from the character")
    parser.add_argument("--motion", type=Path, nargs="+", required=True)
    parser.add_argument("--fit", type=Path, help="corrections that the bakes kept in their work directory, fit-*.npy")
    parser.add_argument("--each", action="store_true", help="also exchange every attribute by itself")
    parser.add_argument("--size", type=int, default=540, help="pixels along a side of an image")
    parser.add_argument("--cache", type=Path, default=Path("build/unseen"), help="keeps the teacher's frames")
    parser.add_argument("-o", "--output", type=Path, help="a directory for images: teacher beside students")
    given = parser.parse_args()
    avatars = {str(path): read(path) for path in given.avatars}
    texels = next(iter(avatars.values())).rig.texels.size
    teacher = Teacher(given.character, given.cache, texels=texels, fit=given.fit)
    found: dict[str, dict[str, list[Figures]]] = {}
    motions = list(motions_of(teacher.character, given.motion))
    for number, (frame, part, figures, images) in enumerate(
        compared(teacher, avatars, motions, size=given.size, each=given.each)
    ):
        for name, one in figures.items():
            found.setdefault(name, {}).setdefault(part, []).append(one)
        if given.output:
            given.output.mkdir(parents=True, exist_ok=True)
            picture = Image.fromarray((255 * np.hstack(images)).round().astype(np.uint8))
            picture.save(given.output / f"{frame} {part} {number % len(SIDES)}.png")
    for name, parts in found.items():
        print(f"{name}: {'; '.join(f'{part} {_means(own)}' for part, own in parts.items())}")


def _means(figures: Sequence[Figures]) -> str:
    psnr, dark = np.mean([(one.psnr, one.dark) for one in figures], axis=0)
    return f"{psnr:.2f} dB, {dark:.1%} dark"


if __name__ == "__main__":
    main()
