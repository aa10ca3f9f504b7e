"""Print how an avatar holds in motion that it was not trained on, beside its simulated teacher, worst motion first.

python tools/research/measure_unseen.py hero.muaavatar hero.glb --recording hero.work/recording-* --motion kicks/

Every motion is cut to four seconds; one frame in five is measured. A live rig with a broken joint and random joint
angles are added. Three figures of the worst frame are held against a bar: how far a splat's centre is from the surface
of the posed template, which is the avatar's mean mesh or the teacher's mesh of that frame carried by the skin,
whichever is nearer, because fast motion carries the teacher's cloth far from the mean; the largest standard deviation
of a splat, in texels of the mean size; how far the mean colour of a block of texels is from the teacher's. Over all
frames of a motion, of each attribute at least nothing of the variance about the mean of the training frames is to be
explained. Lengths are those of a figure as large as a person.
"""

import argparse
import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from unseen_teacher import Motion, Shown, Teacher, broken_rigs, motions_of

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua import rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.avatar.decode import Splats, decode_clip_frame, pose_splats
from mua.avatar.rendering import render_premultiplied, to_bytes
from mua.baking.portrait import portrait
from mua.baking.student_errors import MESH, UNITS, Errors, Picture
from mua.channels import ATTRIBUTES, SH_C0
from mua.fidelity.background import background_for, over
from mua.fidelity.strips import caption, sheet
from mua.files.write import write_bytes
from mua.recording import Recording, WholeFrame
from mua.rig.bones import figure_scale
from mua.rig.texel_map import TexelMap

DISTANCE, SIZE, COLOUR, EXPLAINED = 0.1, 10.0, 40.0, 0.0  # the bars: metres, texels, /255, share
BLOCK, LEAST = 16, 32  # texels along a block of the texture; valid ones that make a mean colour
CONSTANT = 0.01  # RMS about the mean, in the attribute's unit: what varies less is not explained or missed
CELL = (288, 416)  # pixels of an image
PICTURED = 3  # motions
LOOKED_UP = 256  # points at a time


@dataclass
class Result:
    """The figures of one motion, in its worst frame except for the explained variance."""

    name: str
    sound: bool
    frames: int
    distance: float = 0.0  # metres, of a splat's centre from the posed template
    apart: float = 0.0  # metres, of a splat's centre from the teacher's mesh alone
    size: float = 0.0  # texels, the largest standard deviation
    teacher_size: float = 0.0
    colour: float = 0.0  # /255
    mean_colour: float = 0.0  # /255, of the mean texture of the training frames in place of the student's
    worst: int = 0  # the frame that is farthest over a bar
    explained: dict[str, float | None] = field(default_factory=dict)  # by attribute; None where nothing varies

    @property
    def badness(self) -> float:
        """The worst figure relative to its bound."""
        return max(self.distance / DISTANCE, self.size / SIZE, self.colour / COLOUR)

    @property
    def fails(self) -> list[str]:
        """The bars that are not met."""
        bounds = {"distance": self.distance / DISTANCE, "size": self.size / SIZE, "colour": self.colour / COLOUR}
        missed = [name for name, share in bounds.items() if not share <= 1]
        return missed + [name for name, share in self.explained.items() if share is not None and not share >= EXPLAINED]

    def line(self) -> str:
        """A row of the table."""
        shares = [self.explained[name] for name in (*ATTRIBUTES, MESH)]
        cells = [
            self.name,
            str(self.frames),
            f"{100 * self.distance:.1f} ({100 * self.apart:.1f})",
            f"{self.size:.1f} ({self.teacher_size:.1f})",
            f"{self.colour:.0f} ({self.mean_colour:.0f})",
            *("-" if share is None else f"{share:.0%}" for share in shares),
            ", ".join(self.fails),
        ]
        return f"| {' | '.join(cells)} |"


class Ruler:
    """Measures posed splats of one avatar."""

    def __init__(self, avatar: Avatar) -> None:
        rig, mean = avatar.rig, avatar.coarse.mean.reshape(-1, 3).astype(np.float32)
        self._rig, self._mean = rig, mean
        self._figure = figure_scale(rig.mesh.vertices)
        self._texel = texel_length(mean, rig.mesh.faces, len(rig.texels.texels))
        self._blocks = blocks(rig.texels)

    def distances(
        self,
        splats: Splats,
        mesh: Array,  # [V, 3] the teacher's canonical vertices
    ) -> tuple[float, float]:
        """How far centres are at most from the posed template, and from the teacher's mesh alone; metres on a person.

        Surfaces are taken as the points of their texels.
        """
        if not np.isfinite(splats.centres).all():
            return math.inf, math.inf
        surfaces = [self._posed(one, splats.texel_dq) for one in (self._mean, mesh)]
        return farthest(splats.centres, surfaces) / self._figure, farthest(splats.centres, surfaces[1:]) / self._figure

    def _posed(self, mesh: Array, texel_dq: Array) -> Array:
        """The points [N, 3] of canonical vertices [V, 3] where the texels are, in the world."""
        texels = self._rig.texels
        corners = mesh[self._rig.mesh.faces[texels.triangles]]
        return rotation.dual_transform(texel_dq, np.einsum("nk,nkc->nc", texels.barycentrics, corners))

    def size(self, splats: Splats) -> float:
        """The largest standard deviation in texels."""
        return not_nan(splats.scales.max() / self._texel)

    def colour(self, one: Array, other: Array) -> float:
        """The largest difference of the mean colours of a block of two textures [N, 23], /255."""
        return not_nan(np.abs(self._means(one) - self._means(other)).max() * 255)

    def _means(self, texture: Array) -> Array:
        """Mean colours [B, 3] of blocks, each texel as bright as a screen shows it."""
        dc = texture[:, ATTRIBUTES["SH"].start :][:, :3]
        colours = np.clip(0.5 + SH_C0 * dc.astype(np.float64), 0, 1)
        count = np.bincount(self._blocks)
        sums = np.stack([np.bincount(self._blocks, column) for column in colours.T], axis=1)
        return np.asarray(sums[count >= LEAST] / count[count >= LEAST, None])


def farthest(
    points: Array,  # [N, 3]
    surfaces: Sequence[Array],  # [N, 3] each; a point's own place on it is the one of the same row
) -> float:
    """The largest distance of any of the points from the nearest point of any of the surfaces.

    A point is no farther than from its own places, so that few are looked up.
    """
    bounds = np.min([np.linalg.norm(points - surface, axis=1) for surface in surfaces], axis=0)
    trees, found = [cKDTree(surface) for surface in surfaces], 0.0
    for some in np.array_split(np.argsort(-bounds), max(len(points) // LOOKED_UP, 1)):
        if bounds[some[0]] <= found:
            break
        found = max(found, float(np.min([tree.query(points[some])[0] for tree in trees], axis=0).max()))
    return found


def not_nan(value: float) -> float:
    """Count NaN as beyond every bar."""
    return math.inf if math.isnan(value) else float(value)


def texel_length(vertices: Array, faces: Array, texels: int) -> float:
    """Side of a square of the surface's mean share of a texel."""
    a, b, c = np.swapaxes(vertices[faces], 0, 1)
    return float(np.sqrt(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 / texels))


def blocks(texels: TexelMap) -> Array:
    """Which block [N] of the texture each valid texel lies in."""
    row, column = np.divmod(texels.texels, texels.size)
    return np.asarray(row // BLOCK * -(-texels.size // BLOCK) + column // BLOCK)


class Measurement:
    """Compares one avatar with its teacher."""

    def __init__(self, avatar: Avatar, teacher: Teacher, recording: Recording) -> None:
        self.avatar, self.teacher = avatar, teacher
        self._reference = recording.reference.texture
        self._mean = Picture(recording.mean_texture(), recording.mean_mesh())
        self._ruler = Ruler(avatar)

    def measure(self, motion: Motion) -> Result:
        """Student and teacher in the frames of one motion."""
        result, errors = Result(motion.clip.name, motion.sound, len(motion.frames)), Errors()
        worst = -1.0
        for shown in self.shown(motion):
            one = self._one(motion, shown, errors)
            if one.badness > worst:
                worst, result.worst = one.badness, shown.frame
            for name in ("distance", "apart", "size", "teacher_size", "colour", "mean_colour"):
                setattr(result, name, max(getattr(result, name), getattr(one, name)))
        result.explained = {name: explained(errors, name) for name in (*ATTRIBUTES, MESH)}
        return result

    def shown(self, motion: Motion) -> Iterable[Shown]:
        """The teacher's frames."""
        return self.teacher.shown(motion, self._reference)

    def posed(self, motion: Motion, shown: Shown) -> tuple[Splats, Splats]:
        """Teacher and student."""
        pose = motion.clip.pose(shown.frame)
        teacher = pose_splats(self.avatar.rig, shown.mesh, texture=shown.texture, pose=pose)
        return teacher, decode_clip_frame(self.avatar, motion.clip, frame=shown.frame)

    def picture(self, motion: Motion, frame: int) -> Array:
        """Teacher and student in a frame that is measured [h, 2 w, 3]."""
        shown = next(shown for shown in self.shown(motion) if shown.frame == frame)
        posed, pose = self.posed(motion, shown), motion.clip.pose(shown.frame)
        camera = portrait(posed[0], self.avatar.rig.skeleton, pose=pose, screen=CELL)
        drawn = [render_premultiplied(splats, camera) for splats in posed]
        images = [to_bytes(over(image, background_for(drawn[:1]))) for image in drawn]
        titles = (f"teacher: {motion.clip.name}, frame {shown.frame}", "student")
        return np.vstack([caption(titles, CELL[0]), np.hstack(images)])

    def _one(self, motion: Motion, shown: Shown, errors: Errors) -> Result:
        """One frame alone; its errors are added to those of the motion."""
        teacher, student = self.posed(motion, shown)
        whole = WholeFrame(motion.clip, shown.frame, 0, shown.mesh, shown.texture)  # type: ignore[arg-type]
        errors.add(whole, {"mean": self._mean, "student": Picture(student.texture, student.canonical)})
        distance, apart = self._ruler.distances(student, shown.mesh)
        return Result(
            motion.clip.name,
            motion.sound,
            1,
            distance=distance,
            apart=apart,
            size=self._ruler.size(student),
            teacher_size=self._ruler.size(teacher),
            colour=self._ruler.colour(student.texture, shown.texture),
            mean_colour=self._ruler.colour(self._mean.texture, shown.texture),
        )


def explained(errors: Errors, attribute: str) -> float | None:
    """Share of the variance; None where nothing varies, minus infinity where the student is no number."""
    if errors.rms(attribute, "mean") < CONSTANT:
        return None
    share = errors.explained(attribute)
    return share if math.isfinite(share) else -math.inf


def summary(results: Sequence[Result]) -> str:
    """How many motions meet each bar, and the worst of each."""
    sound = [result for result in results if result.sound]
    lines = [
        f"{sum(not result.fails for result in results)} of {len(results)} motions meet all bars;",
        *(
            f"{name}: {sum(name not in result.fails for result in results)} of {len(results)}, worst {shown(results)};"
            for name, shown in (
                ("distance", lambda all: f"{100 * max(result.distance for result in all):.1f} cm"),
                ("size", lambda all: f"{max(result.size for result in all):.1f} texels"),
                ("colour", lambda all: f"{max(result.colour for result in all):.0f}/255"),
            )
        ),
    ]
    for name in (*ATTRIBUTES, MESH):
        shares = [share for result in sound if (share := result.explained[name]) is not None]
        if shares:
            met = sum(share >= EXPLAINED for share in shares)
            lines.append(f"{name} explained: {met} of {len(shares)} sound motions, worst {min(shares):.0%};")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path, help="the avatar")
    parser.add_argument("character", nargs="?", type=Path, help="that it was baked from; none: the procedural one")
    parser.add_argument("--recording", type=Path, required=True, help="in the work directory of the bake")
    parser.add_argument("--motion", type=Path, action="append", default=[], help="file or directory")
    parser.add_argument("--json", type=Path, help="writes all figures")
    parser.add_argument("--sheet", type=Path, help="writes an image of the worst frames of the three worst motions")
    parser.add_argument("--show", action="append", default=[], help="MOTION=FRAME, to be in the image instead")
    given = parser.parse_args()
    avatar = read(given.file)
    fit = given.recording.with_name(f"{given.recording.name.replace('recording', 'fit')}.npy")
    teacher = Teacher(given.character, texels=avatar.rig.texels.size, fit=fit)
    measurement = Measurement(avatar, teacher, Recording(given.recording))
    paths = [path for motion in given.motion for path in (sorted(motion.iterdir()) if motion.is_dir() else [motion])]
    motions = [*motions_of(teacher.character, paths), *broken_rigs(avatar)]
    measured = sorted(
        ((measurement.measure(motion), motion) for motion in motions), key=lambda one: one[0].badness, reverse=True
    )
    report([result for result, _ in measured], given.json)
    if given.sheet:
        worst = {result.name: result.worst for result, _ in measured[:PICTURED]}
        frames = dict(_name_and_frame(text) for text in given.show) or worst
        strips = [
            measurement.picture(motion, frames[name]) for motion in motions if (name := motion.clip.name) in frames
        ]
        sheet(strips, 1).save(given.sheet)


def _name_and_frame(text: str) -> tuple[str, int]:
    name, _, frame = text.rpartition("=")
    return name, int(frame)


def report(results: Sequence[Result], path: Path | None) -> None:
    """Print a line for each motion, then the summary; write the figures."""
    units = "".join(f" {name} |" for name in (*ATTRIBUTES, MESH))
    print(
        "| motion | frames | distance, cm (from the teacher) | size, texels (teacher) | colour, /255 (mean) |"
        + units
        + " misses |"
    )
    print("| --- | ---: | ---: | ---: | ---: |" + " ---: |" * len(UNITS) + " --- |")
    for result in results:
        print(result.line())
    print(summary(results))
    if path is not None:
        write_bytes(path, json.dumps([asdict(result) for result in results], indent=1).encode())


if __name__ == "__main__":
    main()
