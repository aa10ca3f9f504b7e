"""Print how a baked avatar's face comes out in each expression and in speech, beside its simulated teacher.

python tools/research/measure_faces.py hero.muaavatar hero.glb --recording hero.work/recording-* --detail head=3

Held-out frames of the recorded motion are drawn close up, the teacher's beside the avatar's: without expressions, which
is the body's figure; with each expression at 1; and with blinks and visemes that follow each other as in a sentence, or
the weights of `--face`. The teacher moves the character's own surface by the same weights and lights it anew; its cloth
is that of the frame without them. PSNR is over what both cover of the face's box, and over those pixels alone that the
expression changes in the teacher's image; each is held against the body's figure over the same pixels of the same
frames.

Light and shape are told apart by a second teacher, whose surface moves while its colours stay as without expressions,
and by a student of which the same is true. Beside it that teacher is compared with itself at rest, bent as an avatar
bends it, so that nothing learnt plays a part; both also with offsets that do not turn with their triangle.
"""

import argparse
import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import cycle, islice
from pathlib import Path

import moderngl
import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.atlas.detail import read_detail
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import Unposed, express, pose_splats, unposed_clip_frame
from mua.avatar.rendering import to_bytes
from mua.baking.sources import load_character
from mua.channels import APPEARANCE, ATTRIBUTES
from mua.errors import InputError
from mua.fidelity.background import background_for, over
from mua.fidelity.canvas import opened
from mua.fidelity.measure import Agreement, agreement, together
from mua.fidelity.source_faces import AWAY, MOVES, USUAL
from mua.fidelity.splats import SplatPainter
from mua.fidelity.strips import caption, difference, sheet
from mua.files.write import replacing, write_bytes
from mua.motion.face import with_face
from mua.pose.clip import Clip
from mua.pose.descriptor import heading_of
from mua.pose.expression_names import match_expressions
from mua.pose.skeleton import Pose
from mua.recording import Recording
from mua.rig.build import build_rig
from mua.rig.character import Character
from mua.rig.rig import Rig
from mua.teachers.simulated.skinned_surface import MovedSurface
from mua.teachers.simulated.teacher import SimulatedTeacher

RUN_UP = 0.5  # seconds that are simulated before the first frame that is held out
BAR = 1.0  # dB that an expression may cost
CHANGES = 4 / 255  # of a colour from which a pixel shows an expression
PICTURED = 5  # the worst
SPOKEN = 34  # frames of speech
SENTENCE = ("sil", "aa", "E", "nn", "O", "sil", "kk", "aa", "U", "sil", "aa", "RR", "I", "U", "PP", "FF", "SS")
SYLLABLE = 0.1  # seconds from a viseme to the next
BLINK, BETWEEN = 0.2, 0.8  # seconds that a blink takes, and from one to the next
SPEECH = (*(f"viseme_{name}" for name in dict.fromkeys(SENTENCE)), "jawOpen", "eyeBlinkLeft", "eyeBlinkRight")
LIT, UNLIT = "teacher", "teacher in the light at rest"
RELIT, STUDENT, BENT = "student", "student in the light at rest", "bent teacher"
FIXED = ", offsets not turned"
WAYS = {  # what is compared, and with which teacher
    RELIT: (RELIT, LIT),
    STUDENT: (STUDENT, UNLIT),
    STUDENT + FIXED: (STUDENT + FIXED, UNLIT),
    BENT: (BENT, UNLIT),
    BENT + FIXED: (BENT + FIXED, UNLIT),
}


class FacedTeacher(SimulatedTeacher):
    """Puts faces on frames whose cloth is simulated once."""

    def surfaces(self, clip: Clip) -> Iterator[MovedSurface]:
        """The simulated surface of each frame, without expressions."""
        return self._moving.frames(clip)

    def faced(self, pose: Pose, surface: MovedSurface, weights: Array) -> Unposed:
        """The frame with expressions, in canonical space."""
        frame = self.frame_on(replace(pose, expressions=weights), surface)
        return Unposed(frame.mesh, frame.texture, 0.0)


@dataclass(frozen=True, eq=False)
class Frame:
    """A held-out frame without expressions."""

    pose: Pose
    surface: MovedSurface
    teacher: Unposed
    student: Unposed
    camera: Camera
    images: tuple[Array, Array]  # [H, W, 4] the teacher's and the student's


@dataclass(frozen=True)
class Shot:
    """A frame with expressions: agreements with the teacher by WAYS, and the body's over the same pixels."""

    box: dict[str, Agreement]
    body: Agreement
    changed: dict[str, Agreement]  # over the pixels that the expressions change
    changed_body: Agreement


@dataclass(frozen=True)
class Result:
    """Decibels of an expression or of speech over some frames."""

    name: str
    body: float
    box: dict[str, float]
    changed_body: float
    changed: dict[str, float]

    @classmethod
    def of(cls, name: str, shots: Sequence[Shot]) -> "Result":
        return cls(
            name,
            body=together([shot.body for shot in shots]).psnr,
            box={way: together([shot.box[way] for shot in shots]).psnr for way in WAYS},
            changed_body=together([shot.changed_body for shot in shots]).psnr,
            changed={way: together([shot.changed[way] for shot in shots]).psnr for way in WAYS},
        )

    def cost(self, way: str) -> float:
        """Decibels below the body's figure inside the face's box."""
        return self.body - self.box[way]

    def line(self) -> str:
        """A row of the table."""
        numbers = (self.body, *self.box.values(), self.changed_body, *self.changed.values())
        costs = " | ".join(f"{self.cost(way):.2f}" for way in (RELIT, STUDENT))
        return f"| {self.name} | {costs} | " + " | ".join(f"{number:.2f}" for number in numbers) + " |"


class FaceStudio:
    """Draws an avatar and its teacher close up."""

    def __init__(self, context: moderngl.Context, avatar: Avatar, teacher: FacedTeacher, size: int) -> None:
        self._rig, self._avatar, self._teacher, self._size = avatar.rig, avatar, teacher, size
        self._paint = SplatPainter(context, (size, size))
        self._moved = moved_vertices(avatar.rig)

    def frames(self, clip: Clip, run_up: Clip) -> list[Frame]:
        """All frames of a clip, its cloth in motion since `run_up`."""
        surfaces = islice(self._teacher.surfaces(run_up.then(clip)), len(run_up), None)
        none = np.zeros(len(self._avatar.expressions), np.float32)
        frames = []
        for index, surface in enumerate(surfaces):
            pose = clip.pose(index)
            teacher = self._teacher.faced(pose, surface, none)
            student = unposed_clip_frame(self._avatar, clip, frame=index)
            camera = self._camera(pose, teacher)
            images = self.draw(teacher, pose, camera), self.draw(student, pose, camera)
            frames.append(Frame(pose, surface, teacher, student, camera, images))
        return frames

    def draw(self, unposed: Unposed, pose: Pose, camera: Camera) -> Array:
        """Premultiplied sRGB and alpha [H, W, 4]."""
        return self._paint(pose_splats(self._rig, unposed.mesh, texture=unposed.texture, pose=pose), camera)

    def images(self, frame: Frame, weights: Array) -> dict[str, Array]:
        """Both teachers with expressions, and what is compared with them."""
        teacher = self._teacher.faced(frame.pose, frame.surface, weights)
        shown = {LIT: teacher, UNLIT: with_channels(teacher, frame.teacher, APPEARANCE)}
        for name, rest in {STUDENT: frame.student, BENT: frame.teacher}.items():
            mesh, texture = express(self._rig, rest.mesh, texture=rest.texture, weights=weights)
            shown[name] = with_channels(Unposed(mesh, texture, 0.0), rest, APPEARANCE)
            if name == STUDENT:
                shown[RELIT] = Unposed(mesh, texture, 0.0)
            shown[name + FIXED] = with_channels(shown[name], rest, ATTRIBUTES["offset"])
        return {name: self.draw(unposed, frame.pose, frame.camera) for name, unposed in shown.items()}

    def shot(self, frame: Frame, weights: Array) -> Shot:
        """Measure one frame with expressions."""
        images, (rest, student) = self.images(frame, weights), frame.images
        changes = (np.abs(images[UNLIT] - rest).max(axis=-1) > CHANGES)[..., None]
        pairs = {way: (images[truth], images[name]) for way, (name, truth) in WAYS.items()}
        return Shot(
            box={way: agreement(*pair) for way, pair in pairs.items()},
            body=agreement(rest, student),
            changed={way: agreement(truth * changes, image * changes) for way, (truth, image) in pairs.items()},
            changed_body=agreement(rest * changes, student * changes),
        )

    def strip(self, name: str, frame: Frame, weights: Array) -> Array:
        """The teacher, the student and what sets them apart, also in the light at rest [h, 5 w, 3]."""
        images = self.images(frame, weights)
        background = background_for([images[LIT]])
        truth, shape, student = (over(images[name], background) for name in (LIT, UNLIT, RELIT))
        still = over(images[STUDENT], background)
        titles = (f"{name}: {LIT}", RELIT, "difference", STUDENT, "difference in shape")
        shown = [
            to_bytes(image) for image in (truth, student, difference(truth, student), still, difference(shape, still))
        ]
        return np.vstack([caption(titles, self._size), np.hstack(shown)])

    def _camera(self, pose: Pose, teacher: Unposed) -> Camera:
        """The view of the box about what expressions move, a little aside of where the head looks."""
        posed = pose_splats(self._rig, teacher.mesh, texture=teacher.texture, pose=pose).mesh[self._moved]
        box = np.percentile(posed, [100 - USUAL, USUAL], axis=0)
        weights = np.bincount(self._rig.skin_indices[self._moved].ravel(), self._rig.skin_weights[self._moved].ravel())
        joints = self._rig.skeleton.skinning(pose.rotations, pose.translations)
        heading = heading_of(joints[np.argmax(weights), :4])
        yaw = 2 * np.arctan2(heading[2], heading[0])
        return orbit(box, screen=(self._size, self._size), azimuth=float(yaw) + AWAY)


def with_channels(unposed: Unposed, other: Unposed, channels: slice) -> Unposed:
    """The frame with some of the channels of another."""
    texture = unposed.texture.copy()
    texture[:, channels] = other.texture[:, channels]
    return replace(unposed, texture=texture)


def moved_vertices(rig: Rig) -> Array:
    """The vertices of the template that any expression moves by a good part of what it moves the most."""
    assert rig.expressions is not None
    expressions, found = rig.expressions, []
    lengths = np.linalg.norm(expressions.offsets, axis=1)
    for start, end in zip(expressions.starts, expressions.starts[1:], strict=False):
        own = lengths[start:end]
        found.append(expressions.vertices[start:end][own > MOVES * own.max(initial=0)])
    return np.unique(np.concatenate(found))


def speech(names: Sequence[str], times: Array) -> Array:
    """Weights [T, E] at times in seconds: visemes that fade into each other, a jaw that follows, and blinks."""
    weights = np.zeros((len(times), len(SPEECH)))
    at = times / SYLLABLE
    for place, viseme in enumerate(SENTENCE):
        weights[:, SPEECH.index(f"viseme_{viseme}")] += np.clip(1 - np.abs(at - place), 0, 1)
    open_mouth = [SPEECH.index(f"viseme_{viseme}") for viseme in ("aa", "E", "O")]
    weights[:, SPEECH.index("jawOpen")] = 0.3 * weights[:, open_mouth].sum(axis=1)
    blink = np.clip(1 - np.abs(times % BETWEEN - BLINK) / (BLINK / 2), 0, 1)
    for side in ("Left", "Right"):
        weights[:, SPEECH.index(f"eyeBlink{side}")] = blink
    return np.clip(weights @ match_expressions(names, SPEECH).T, 0, 1).astype(np.float32)


def held_out(recording: Recording) -> tuple[Clip, Clip]:
    """The first clip that is held out, and what comes before it."""
    clips = [Clip(clip.name, clip.rate, clip.rotations, clip.translations) for clip in recording.clips]
    held = next(i for i, clip in enumerate(recording.clips) if clip.held_out)
    before = next((clip for clip in clips if clips[held].name == f"{clip.name} (end)"), clips[held].cut(slice(0, 1)))
    return clips[held], before.cut(slice(-round(RUN_UP * before.rate), None))


def spoken(avatar: Avatar, clip: Clip, face: Path | None) -> Array:
    """Weights [T, E] of speech."""
    if face is None:
        return speech(avatar.expressions, np.arange(SPOKEN) * SYLLABLE * len(SENTENCE) / SPOKEN)
    longer = clip.cut(np.array(list(islice(cycle(range(len(clip))), SPOKEN))))
    weights = with_face([longer], face, avatar.expressions)[0][0].expressions
    assert weights is not None
    return weights.astype(np.float32)


def measure(studio: FaceStudio, frames: Sequence[Frame], avatar: Avatar, sequence: Array, each: int) -> list[Result]:
    """Speech over all frames, then every expression over `each` of them, if any."""
    shots = [studio.shot(frame, weights) for frame, weights in zip(cycle(frames), sequence, strict=False)]
    results = [Result.of("speech", shots)]
    if not each:
        return results
    chosen = [frames[int((i + 0.5) * len(frames) / each)] for i in range(each)]
    for name, weights in zip(avatar.expressions, np.eye(len(avatar.expressions), dtype=np.float32), strict=True):
        results.append(Result.of(name, [studio.shot(frame, weights) for frame in chosen]))
    return [results[0], *sorted(results[1:], key=lambda result: -result.cost(RELIT))]


def report(results: Sequence[Result]) -> None:
    """Print a line for each result, then how many meet the bar."""
    columns = ("body", *WAYS, "body, changed", *(f"{way}, changed" for way in WAYS))
    print("| expression | cost, relit | cost | " + " | ".join(columns) + " |")
    print("| --- |" + " ---: |" * (2 + len(columns)))
    for result in results:
        print(result.line())
    for way in (RELIT, STUDENT):
        met = sum(result.cost(way) <= BAR for result in results)
        print(f"{way}: {met} of {len(results)} cost at most {BAR:g} dB inside the face's box")


def load_teacher(given: argparse.Namespace, rig: Rig) -> FacedTeacher:
    """The teacher of the bake, with the corrections that it kept. Errors: InputError where the avatar is another's."""
    character: Character = load_character(
        given.character, uv="auto", seed=0, detail=read_detail(given.detail, uv="auto")
    )
    if rig.expressions is None:
        raise InputError(f"{given.file}: has no expressions to measure")
    own, _ = build_rig(character, texels=rig.texels.size)
    pairs = (own.texels.texels, rig.texels.texels), (own.mesh.faces, rig.mesh.faces)
    if not all(np.array_equal(*pair) for pair in pairs):
        raise InputError(
            f"{given.file}: its texels or triangles are not those of {given.character} now, expected a bake by this "
            f"version with --detail {' '.join(given.detail) or 'left out'}"
        )
    fit = given.recording.with_name(f"{given.recording.name.replace('recording', 'fit')}.npy")
    teacher = FacedTeacher(replace(character, clips=(), source=None), texels=rig.texels.size)
    return teacher.corrected(np.load(fit)) if fit.exists() else teacher


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path, help="the avatar")
    parser.add_argument("character", type=Path, help="that it was baked from")
    parser.add_argument("--recording", type=Path, required=True, help="in the work directory of the bake")
    parser.add_argument("--detail", action="append", default=[], help="as the bake was given it")
    parser.add_argument("--face", type=Path, help="facial motion to be the speech")
    parser.add_argument("--frames", type=int, default=2, help="held-out frames for each expression; 0: speech alone")
    parser.add_argument("--size", type=int, default=288, help="pixels along a side of an image")
    parser.add_argument("--json", type=Path, help="writes all figures")
    parser.add_argument("--sheet", type=Path, help="writes an image of the worst five expressions")
    given = parser.parse_args()
    avatar = read(given.file)
    clip, run_up = held_out(Recording(given.recording))
    with opened() as context:
        studio = FaceStudio(context, avatar, load_teacher(given, avatar.rig), given.size)
        frames = studio.frames(clip, run_up)
        results = measure(studio, frames, avatar, spoken(avatar, clip, given.face), given.frames)
        report(results)
        if given.json:
            write_bytes(given.json, json.dumps([asdict(result) for result in results], indent=1).encode())
        if given.sheet:
            worst = [result.name for result in results[1 : 1 + PICTURED]]
            alone = dict(zip(avatar.expressions, np.eye(len(avatar.expressions), dtype=np.float32), strict=True))
            strips = [studio.strip(name, frames[len(frames) // 2], alone[name]) for name in worst]
            with replacing(given.sheet) as temporary:
                sheet(strips, 1).save(temporary, format="png")


if __name__ == "__main__":
    main()
