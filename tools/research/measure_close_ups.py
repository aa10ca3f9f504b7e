"""Draw the head, a hand and the open borders of characters close up, source beside splats, and print how they differ.

python tools/research/measure_close_ups.py hero.glb witch.vrm --texels 256 -o close_ups/

Both are drawn as the file stands, without light or motion, from the front and from behind, so that the part fills the
image. PSNR is over all pixels that either of them covers, on grey, and over those within BORDER of an open border of
the surface. "Dark" is the share of pixels within FRINGE outside the source's silhouette that are darker than both the
nearest pixel of the source and the background: a fringe.
"""

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import distance_transform_edt

from mua.arrays import Array
from mua.atlas.detail import read_detail
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import pose_splats
from mua.baking.one_sided import open_edges
from mua.baking.sources import load_character
from mua.fidelity.background import over
from mua.fidelity.canvas import opened
from mua.fidelity.measure import MOST_DECIBELS
from mua.fidelity.painter import Painter
from mua.fidelity.posing import Moment, Poser, skinned
from mua.fidelity.splats import SplatPainter
from mua.rig.body_parts import BODY_PARTS, body_parts
from mua.rig.character import Character
from mua.teachers.simulated.still import StillTeacher
from mua.teachers.simulated.surface import SkinnedSurface

GREY = 0.5
BORDER, FRINGE = 0.02, 0.01  # metres about an open border, and outside the silhouette
COVERED = 0.02  # opacity
DARKER = 0.04  # of the sRGB range
SIDES = {"front": 0.0, "behind": 150.0}  # degrees round the figure
BANDS, BAND = 30, 0.08  # heights at which borders are looked for, and the height of a band over the figure's


@dataclass(frozen=True)
class Figures:
    """How splats differ from their source in one image."""

    psnr: float  # dB, of what either covers
    border: float  # dB, within BORDER of an open border; NaN where there is none
    dark: float  # share of the pixels within FRINGE outside the silhouette


def measured(
    source: Array,  # [H, W, 4] premultiplied sRGB and alpha
    splats: Array,  # [H, W, 4]
    near_border: Array,  # [H, W] bool
    *,
    scale: float,  # pixels along a metre
) -> Figures:
    """Compare one image of a part."""
    silhouette = source[..., 3] > COVERED
    covered = silhouette | (splats[..., 3] > COVERED)
    one, other = over(source, GREY), over(splats, GREY)
    away, nearest = distance_transform_edt(~silhouette, return_indices=True)
    ring = (away > 0) & (away <= FRINGE * scale)
    beside = np.minimum(one.mean(axis=-1)[tuple(nearest)], GREY)
    dark = ring & (other.mean(axis=-1) < beside - DARKER)
    return Figures(
        psnr=decibels(one, other, covered),
        border=decibels(one, other, covered & near_border),
        dark=float(dark.sum() / max(ring.sum(), 1)),
    )


def decibels(one: Array, other: Array, where: Array) -> float:
    """The PSNR over these pixels, at most MOST_DECIBELS; NaN where there are none."""
    if not where.any():
        return float("nan")
    return float(min(-10 * np.log10(max(np.mean((one - other)[where] ** 2), np.finfo(float).tiny)), MOST_DECIBELS))


def parts_of(character: Character, places: Array) -> Iterator[tuple[str, Array]]:
    """Names and boxes [2, 3] of the head, the hand with the greater x and the height with most open borders."""
    mesh = character.mesh
    part = body_parts(
        character.skeleton, mesh.faces, character.skin_indices, character.skin_weights, stated=character.roles
    )
    head, hands = (places[mesh.faces[part == BODY_PARTS.index(name)]].reshape(-1, 3) for name in ("head", "hands"))
    hand = hands[hands[:, 0] > places[:, 0].mean()] if len(hands) else hands
    for name, points in (("head", head), ("hand", hand)):
        if len(points):
            yield name, np.stack([points.min(axis=0), points.max(axis=0)])
    edges = open_edges(mesh.vertices, mesh.faces)
    points = places[edges].mean(axis=1)
    height = float(np.ptp(places[:, 1]))
    points = points[points[:, 1] < (head[:, 1].min() if len(head) else places[:, 1].max())]
    if len(points):
        levels = np.linspace(points[:, 1].min(), points[:, 1].max(), BANDS)
        within = np.abs(points[:, 1] - levels[:, None]) < BAND * height / 2
        band = points[within[within.sum(axis=1).argmax()]]
        yield "hem", np.stack([band.min(axis=0), band.max(axis=0)])


def near(points: Array, camera: Camera, *, pixels: float) -> Array:
    """The pixels [H, W] within this distance of the images of points [n, 3]."""
    width, height = camera.screen
    seen = np.zeros((height, width), bool)
    clip = np.column_stack([points, np.ones(len(points))]) @ (camera.projection @ camera.view).T
    clip = clip[clip[:, 3] > 0]
    column, row = (((clip[:, :2] / clip[:, 3:] * [1, -1] + 1) / 2) * camera.screen).astype(int).T
    inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
    seen[row[inside], column[inside]] = True
    return np.asarray(distance_transform_edt(~seen) <= pixels) if seen.any() else seen


def close_ups(path: Path, *, texels: int, size: int) -> Iterator[tuple[str, Array, Figures]]:
    """Each part from each side: its name, source beside splats [size, 2 size, 3] in 0..1, and how they differ."""
    character = load_character(path, uv="auto", seed=0, detail=read_detail((), uv="auto"))
    if character.source is None:
        raise SystemExit(f"{path}: this format keeps nothing to compare with")
    poser = Poser(character.source, character.skeleton)
    moment: Moment = poser.rest()
    teacher = StillTeacher(character, texels=texels)
    shown = teacher.frame(moment.pose, moment.stretches)
    frame = pose_splats(teacher.rig, shown.mesh, texture=shown.texture, pose=moment.pose)
    scene = character.source.scene
    joints = character.skeleton.skinning(moment.pose.rotations, moment.pose.translations)
    places = SkinnedSurface(character).posed(joints, moment.stretches).places
    borders = places[open_edges(character.mesh.vertices, character.mesh.faces)].mean(axis=1)
    with opened() as context:
        paint = Painter(context, scene.parts, scene.materials, screen=(size, size))
        splat = SplatPainter(context, (size, size))
        drawn = [skinned(scene, part, moment.nodes) for part in scene.parts]
        for name, box in parts_of(character, places):
            for side, degrees in SIDES.items():
                camera = orbit(box, screen=(size, size), azimuth=moment.yaw + float(np.radians(degrees)))
                middle = camera.view @ np.append(box.mean(axis=0), 1)
                scale = float(camera.projection[1, 1] * size / 2 / -middle[2])
                source, splats = paint(drawn, camera), splat(frame, camera)
                figures = measured(source, splats, near(borders, camera, pixels=BORDER * scale), scale=scale)
                yield f"{name}, {side}", np.hstack([over(source, GREY), over(splats, GREY)]), figures


def main(arguments: list[str] | None = None) -> None:
    """Write an image of each part and side, and print the figures and their means."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("characters", type=Path, nargs="+")
    parser.add_argument("--texels", type=int, default=256)
    parser.add_argument("--size", type=int, default=1080, help="pixels along a side of an image")
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    for path in options.characters:
        found = []
        for name, image, figures in close_ups(path, texels=options.texels, size=options.size):
            file = options.output / f"{path.stem} {name.replace(', ', ' ')}.png"
            Image.fromarray((255 * image).round().astype(np.uint8)).save(file)
            print(_line(f"{path.stem}, {name}", figures), flush=True)
            found.append((figures.psnr, figures.border, figures.dark))
        borders = [border for _, border, _ in found if not np.isnan(border)]
        mean = np.mean(found, axis=0)
        border = float(np.mean(borders)) if borders else float("nan")
        print(_line(f"{path.stem}, mean", replace(Figures(*mean), border=border)), flush=True)


def _line(name: str, figures: Figures) -> str:
    return f"{name}: {figures.psnr:.2f} dB, at borders {figures.border:.2f} dB, {figures.dark:.1%} dark outside"


if __name__ == "__main__":
    main()
