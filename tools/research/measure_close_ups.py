"""Draw the head, a hand and the open borders of characters close up, source beside splats, and print how they differ.

python tools/research/measure_close_ups.py hero.glb witch.vrm --texels 256 -o close_ups/
python tools/research/measure_close_ups.py hero.glb --avatar hero.muaavatar --motion kicks/ -o close_ups/
python tools/research/measure_close_ups.py hero.glb --before before/ -o close_ups/

Both are drawn without light, from the front and from behind, so that the part fills the image: as the file stands, or
in the last frame and the middle one of every motion. An avatar that was baked from the character is drawn beside them
with the light and the moving cloth that it learnt, and once more with the splats' colours in place of its own, unlit,
whose figures follow those of the splats. Give --fit with it, the fit-*.npy of the bake's work directory.

PSNR is over all pixels that either of them covers, on grey, and over those within BORDER of an open border of the
surface. FLIP is the mean over the same pixels, of which --per-degree lie along a degree of the eye. "Dark" is the
share of pixels within FRINGE outside the source's silhouette that are darker than both the nearest pixel of the source
and the background: a fringe. The bounds, after "of", are those of the surface itself under its atlas averaged to so
many texels. The splats are fitted to the source first, in poses of the built-in range of motion, as a bake fits them.
With --before the splats that still_splats.py kept of another commit are drawn next to the source, and their figures
come first.

With --hanging the source is its surface as loose parts hang in the simulated teacher, under the character's atlas, and
the splats lie on it: cloth that hangs beside where the file's joints have it then is no fringe.
"""

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass, fields
from itertools import islice
from pathlib import Path

import flip_evaluator
import numpy as np
from PIL import Image
from scipy.ndimage import distance_transform_edt
from unseen_teacher import motions_of

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.atlas.detail import read_detail
from mua.atlas.filtering import reduced
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import Splats, decode_clip_frame, pose_splats
from mua.baking.one_sided import open_edges
from mua.baking.sources import load_character
from mua.channels import ATTRIBUTES
from mua.fidelity import fitting
from mua.fidelity.background import over
from mua.fidelity.canvas import opened
from mua.fidelity.measure import MOST_DECIBELS
from mua.fidelity.painter import Painter
from mua.fidelity.posed_source import Moment, Poser, skinned
from mua.fidelity.splats import SplatPainter
from mua.motion.range import motion_range
from mua.pose.clip import Clip
from mua.pose.encoding import RATE
from mua.rig.body_parts import BODY_PARTS, body_parts
from mua.rig.character import Character
from mua.scene import Material, Part
from mua.teachers.simulated.simulated_surface import SimulatedSurface
from mua.teachers.simulated.skinned_surface import MovedSurface, SkinnedSurface
from mua.teachers.simulated.still import StillTeacher

GREY = 0.5
BORDER, FRINGE = 0.02, 0.01  # metres about an open border, and outside the silhouette
PER_DEGREE = 25.0  # pixels of a degree of the eye, about those of a headset, for FLIP
COVERED = 0.02  # opacity
DARKER = 0.04  # of the sRGB range
SIDES = {"front": 0.0, "behind": 150.0}  # degrees round the figure
BANDS, BAND = 30, 0.08  # heights at which borders are looked for, and the height of a band over the figure's


@dataclass(frozen=True)
class Figures:
    """How splats differ from their source in one image."""

    psnr: float  # dB, of what either covers
    border: float  # dB, within BORDER of an open border; NaN where there is none
    flip: float  # 0 where none is seen to 1, of what either covers
    border_flip: float  # within BORDER of an open border; NaN where there is none
    dark: float  # share of the pixels within FRINGE outside the silhouette


def measured(
    source: Array,  # [H, W, 4] premultiplied sRGB and alpha
    splats: Array,  # [H, W, 4]
    near_border: Array,  # [H, W] bool
    *,
    scale: float,  # pixels along a metre
    per_degree: float = PER_DEGREE,
) -> Figures:
    """Compare one image of a part."""
    silhouette = source[..., 3] > COVERED
    covered = silhouette | (splats[..., 3] > COVERED)
    one, other = over(source, GREY), over(splats, GREY)
    away, nearest = distance_transform_edt(~silhouette, return_indices=True)
    ring = (away > 0) & (away <= FRINGE * scale)
    beside = np.minimum(one.mean(axis=-1)[tuple(nearest)], GREY)
    dark = ring & (other.mean(axis=-1) < beside - DARKER)
    flip = perceived(one, other, per_degree)
    bordering = flip[covered & near_border]
    return Figures(
        psnr=decibels(one, other, covered),
        border=decibels(one, other, covered & near_border),
        flip=float(flip[covered].mean()),
        border_flip=float(bordering.mean()) if bordering.size else float("nan"),
        dark=float(dark.sum() / max(ring.sum(), 1)),
    )


def decibels(one: Array, other: Array, where: Array) -> float:
    """The PSNR over these pixels, at most MOST_DECIBELS; NaN where there are none."""
    if not where.any():
        return float("nan")
    return float(min(-10 * np.log10(max(np.mean((one - other)[where] ** 2), np.finfo(float).tiny)), MOST_DECIBELS))


def perceived(one: Array, other: Array, per_degree: float) -> Array:
    """FLIP of each pixel [H, W]."""
    images = (np.ascontiguousarray(image, np.float32) for image in (one, other))
    seen = {"ppd": per_degree}
    differs = flip_evaluator.evaluate(*images, "LDR", applyMagma=False, computeMeanError=False, parameters=seen)
    return np.asarray(differs[0][..., 0], np.float64)


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


def moments(character: Character, motion: Sequence[Path]) -> Iterator[tuple[Moment, Clip, int]]:
    """The poses to draw, each with its clip and frame; the rest pose where there is no motion."""
    assert character.source is not None
    poser = Poser(character.source, character.skeleton)
    for clip in (one.clip for one in motions_of(character, motion)):
        for frame in (len(clip) // 2, len(clip) - 1):
            yield poser.of_clip(clip, frame), clip, frame
    if not motion:
        rest = poser.rest()
        yield rest, Clip(rest.name, RATE, rest.pose.rotations[None], rest.pose.translations[None]), 0


def surface_of(character: Character, moment: Moment, clip: Clip, at: int, *, hanging: bool) -> MovedSurface:
    """The surface in a frame of a clip: skinned, or as its loose parts hang after the frames before it."""
    if hanging:
        return next(islice(SimulatedSurface(character).frames(clip), at, None))
    joints = character.skeleton.skinning(moment.pose.rotations, moment.pose.translations)
    return SkinnedSurface(character).posed(joints, moment.stretches)


def as_textured(character: Character, texels: int) -> tuple[list[Part], list[Material]]:
    """The surface as one part, and its atlas averaged to so many texels."""
    mesh, unused = character.mesh, np.zeros((len(character.mesh.vertices), 1))
    part = Part("surface", 0, mesh.vertices, mesh.faces, mesh.uv, mesh.uv_faces, 0, 0, unused.astype(int), unused)
    return [part], [Material("atlas", reduced(character.base_color, len(character.base_color) // texels))]


def kept_splats(file: Path) -> Splats:
    """What still_splats.py wrote."""
    with np.load(file) as kept:
        return Splats(**{field.name: kept[field.name] for field in fields(Splats) if field.name in kept})


def unlit(student: Splats, teacher: StillTeacher, texture: Array, moment: Moment) -> Splats:
    """A student's splats in the colours of this texture [N, 23]."""
    own = student.texture.copy()
    own[:, ATTRIBUTES["SH"]] = texture[:, ATTRIBUTES["SH"]]
    return pose_splats(teacher.rig, student.canonical, texture=own, pose=moment.pose)


def close_ups(
    path: Path,
    *,
    texels: int,
    size: int,
    steps: int,
    before: Path | None,
    avatar: Avatar | None,
    fit: Path | None,
    motion: Sequence[Path],
    hanging: bool,
    per_degree: float,
) -> Iterator[tuple[str, Array, dict[str, Figures]]]:
    """Each part from each side in each pose: its name, images [size, n size, 3], the figures of all but the source."""
    character = load_character(path, uv="auto", seed=0, detail=read_detail((), uv="auto"))
    if character.source is None:
        raise SystemExit(f"{path}: this format keeps nothing to compare with")
    clips = motion_range(character, (), frames=fitting.POSES, seed=0, short=True)
    teacher = StillTeacher(character, texels=texels)
    if fit is not None:
        teacher = teacher.corrected(np.load(fit))
    elif steps:
        corrections = fitting.fit(character, clips, teacher=teacher, source=character.source, steps=steps)
        teacher = teacher.corrected(corrections)
    edges = open_edges(character.mesh.vertices, character.mesh.faces)
    scene = character.source.scene
    looks = as_textured(character, len(character.base_color)) if hanging else (scene.parts, scene.materials)
    with opened() as context:
        paint, textured = (
            Painter(context, *one, screen=(size, size)) for one in (looks, as_textured(character, texels))
        )
        splat = SplatPainter(context, (size, size))
        for moment, clip, at in moments(character, motion):
            surface = surface_of(character, moment, clip, at, hanging=hanging)
            shown, places = teacher.frame_on(moment.pose, surface), surface.places
            frames = {} if before is None else {"before": kept_splats(before / f"{path.stem}.npz")}
            frames["now"] = pose_splats(teacher.rig, shown.mesh, texture=shown.texture, pose=moment.pose)
            if avatar is not None:
                frames["avatar"] = decode_clip_frame(avatar, clip, frame=at)
                frames["unlit"] = unlit(frames["avatar"], teacher, shown.texture, moment)
            drawn = [places] if hanging else [skinned(scene, part, moment.nodes) for part in scene.parts]
            for part_name, box in parts_of(character, places):
                for side, degrees in SIDES.items():
                    camera = orbit(box, screen=(size, size), azimuth=moment.yaw + float(np.radians(degrees)))
                    middle = camera.view @ np.append(box.mean(axis=0), 1)
                    scale = float(camera.projection[1, 1] * size / 2 / -middle[2])
                    source = paint(drawn, camera)
                    splats = {name: splat(frame, camera) for name, frame in frames.items()}
                    border = near(places[edges].mean(axis=1), camera, pixels=BORDER * scale)
                    images = {"bound": textured([places], camera), **splats}
                    seen = {"scale": scale, "per_degree": per_degree}
                    yield (
                        f"{moment.name}, {part_name}, {side}",
                        np.hstack([over(image, GREY) for image in (source, *splats.values())]),
                        {name: measured(source, image, border, **seen) for name, image in images.items()},
                    )


def main(arguments: list[str] | None = None) -> None:
    """Write an image of each part and side, and print the figures and their means."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("characters", type=Path, nargs="+")
    parser.add_argument("--texels", type=int, default=256)
    parser.add_argument("--size", type=int, default=1080, help="pixels along a side of an image")
    parser.add_argument("--steps", type=int, default=fitting.STEPS, help="of the fit to the source; 0: none")
    parser.add_argument("--before", type=Path, help="a folder of still_splats.py, to be drawn and measured beside it")
    parser.add_argument("--avatar", type=Path, help="what was baked from the one character, to be drawn beside it")
    parser.add_argument("--fit", type=Path, help="corrections that the bake of --avatar kept, in place of a fit")
    parser.add_argument("--motion", type=Path, nargs="+", default=[], help="motion files to pose the characters by")
    parser.add_argument("--hanging", action="store_true", help="compare with the surface as loose parts of it hang")
    parser.add_argument("--per-degree", type=float, default=PER_DEGREE, help="pixels of a degree of the eye, for FLIP")
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    if options.before and options.motion:
        parser.error("--before keeps splats of the file as it stands: leave out --motion")
    avatar = options.avatar and read(options.avatar)
    for path in options.characters:
        found: dict[str, list[tuple[float, ...]]] = {}
        drawn = close_ups(
            path,
            texels=options.texels,
            size=options.size,
            steps=options.steps,
            before=options.before,
            avatar=avatar,
            fit=options.fit,
            motion=options.motion,
            hanging=options.hanging,
            per_degree=options.per_degree,
        )
        for name, image, figures in drawn:
            file = options.output / f"{path.stem} {name.replace(', ', ' ')}.png"
            Image.fromarray((255 * image).round().astype(np.uint8)).save(file)
            print(_line(f"{path.stem}, {name}", figures), flush=True)
            for which, one in figures.items():
                found.setdefault(which, []).append(astuple(one))
        means = {which: Figures(*np.nanmean(rows, axis=0)) for which, rows in found.items()}
        print(_line(f"{path.stem}, mean", means), flush=True)


def _line(name: str, figures: dict[str, Figures]) -> str:
    shown = [figures[which] for which in ("before", "now", "unlit") if which in figures]

    def each(field: str, form: str) -> str:
        return " -> ".join(format(getattr(one, field), form) for one in shown)

    bound = figures["bound"]
    own = f"{name}: {each('psnr', '.2f')} dB of {bound.psnr:.2f} dB, at borders {each('border', '.2f')} dB"
    seen = f", FLIP {each('flip', '.4f')} of {bound.flip:.4f}"
    at_borders = f", at borders {each('border_flip', '.4f')} of {bound.border_flip:.4f}"
    return own + seen + at_borders + f", {each('dark', '.1%')} dark outside"


if __name__ == "__main__":
    main()
