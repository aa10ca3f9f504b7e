"""A look at a character and its motion before a bake: what the splats keep of the one and the clips of the other."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from threadpoolctl import threadpool_limits

from mua.baking.listener import Listener
from mua.baking.settings import BakeSettings
from mua.baking.sources import clips_of, faced, load_baked_character
from mua.characters.expression_file import write_expression_names
from mua.characters.messages import LOOKS_WRONG, is_about
from mua.errors import InputError
from mua.fidelity import report
from mua.fidelity.compare import Fidelity, compare, sittings_of
from mua.fidelity.face_sheet import face_sheet
from mua.fidelity.sheet import fidelity_sheet
from mua.fidelity.source_process import SourceProcess
from mua.files.write import replacing, require_writable, write_bytes
from mua.motion.load import LoadedMotion, counted, load_motions
from mua.motion.mapping import write_mapping
from mua.motion.match import JointPair, joint_pairs, match_joints, require_limbs, unmatched_target
from mua.motion.quality import MotionQuality, measure_motion
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.encoding import RATE
from mua.rig.character import Character
from mua.teachers.simulated.still import StillTeacher

FAST = 1  # of a PNG's levels: a tenth larger than by the best, in a third of the time
MADE = 30  # recorded frames whose range of motion is made where a character has no motion: all of its moves begin
WITHOUT_FILE = "the procedural character has no file, so there is nothing to compare its splats with"


@dataclass(frozen=True)
class Check:
    """What was found."""

    fidelity: Fidelity | None  # None where there is nothing to compare or to draw with
    motions: tuple[MotionQuality, ...]
    matched: tuple[JointPair, ...]
    unmatched: tuple[str, ...]  # joints with skin that no motion moves
    notes: tuple[str, ...]  # what the readers changed or left out
    warnings: tuple[str, ...]  # what looks wrong
    written: tuple[Path, ...]


def check(settings: BakeSettings, listener: Listener, *, every_face: bool = False) -> Check:
    """Measure fidelity and motion, and leave images, and files of names to start from, beside the output.

    With `every_face`, the image of the face shows each expression, else of many only those least like the file.

    Raises InputError where the character or a motion cannot be read, or where nothing can be written.
    """
    require_writable(settings.output)
    listener.stage("character")
    with threadpool_limits(1, user_api="blas"), SourceProcess() as process:  # as in a bake
        process.expect(settings.character)
        character = load_baked_character(settings, read=process.begin)
        return _check(settings, character, listener, process=process, every_face=every_face)


def _check(
    settings: BakeSettings,
    character: Character,
    listener: Listener,
    *,
    process: SourceProcess,
    every_face: bool,
) -> Check:
    listener.stage("motion")
    loaded = _loaded(settings, character)
    qualities = tuple(_quality(settings, character, motion) for motion in loaded)
    listener.stage("comparison with source")
    clips, made = _clips(settings, character, loaded)
    clips, of_face = faced(character, clips, settings.face)
    fidelity, warnings = fidelity_of(character, clips, texels=settings.student.texels, process=process)
    pairs, unmatched = _matched(character, loaded) if settings.motions else ((), ())
    doubtful = [note for note in character.notes if any(is_about(note, sentence) for sentence in LOOKS_WRONG)]
    noted = [note for note in character.notes if note not in doubtful]
    written = []
    if fidelity is not None:
        written.append(settings.beside("_check.png"))
        write_sheet(written[0], fidelity_sheet(fidelity))
        if fidelity.face is not None:
            written.append(settings.beside("_check_face.png"))
            write_sheet(written[-1], face_sheet(fidelity.face, every=every_face))
    if character.expressions is not None:
        written.append(settings.beside("_expressions.json"))
        write_expression_names(written[-1], character.expression_names)
    if pairs or unmatched:
        written.append(settings.beside("_mapping.json"))
        write_mapping(written[-1], pairs, unmatched)
    return Check(
        fidelity=fidelity,
        motions=qualities,
        matched=pairs,
        unmatched=unmatched,
        notes=counted((*noted, *made, *_notes(loaded), *of_face), clips),
        warnings=(
            *_refusals(settings, character, loaded),
            *doubtful,
            *warnings,
            *(flaw for quality in qualities for flaw in quality.flaws),
        ),
        written=tuple(written),
    )


def fidelity_of(
    character: Character,
    clips: Sequence[Clip],
    *,
    texels: int,
    teacher: StillTeacher | None = None,
    process: SourceProcess | None = None,
) -> tuple[Fidelity | None, tuple[str, ...]]:
    """How much the splats look like the character, and a sentence for what is poor; None where nothing is measured.

    The splats are those of `teacher`, or as many as `texels` says. With a `process`, also in each of its expressions.
    """
    if character.source is None:
        return None, (WITHOUT_FILE,)
    try:
        if process is not None:
            process.draw_poses(sittings_of(character, clips, character.source))
        teacher = teacher or StillTeacher(character, texels=texels)
        fidelity = compare(character, clips, teacher=teacher, source=character.source, process=process)
    except InputError as error:
        return None, (f"The splats were not compared with the source: {error}.",)
    return fidelity, report.sentences(fidelity)


def write_sheet(path: Path, picture: Image.Image) -> None:
    """Write a picture of source beside splats."""
    with replacing(path) as temporary:
        picture.save(temporary, compress_level=FAST)


def as_dict(settings: BakeSettings, found: Check) -> dict[str, Any]:
    """Every figure, unrounded."""
    return {
        "character": None if settings.character is None else str(settings.character),
        "texels": settings.student.texels,
        "fidelity": None if found.fidelity is None else report.as_dict(found.fidelity),
        "motion": [_without_flaws(quality) for quality in found.motions],
        "matched": [asdict(pair) for pair in found.matched],
        "unmatched": found.unmatched,
        "warnings": found.warnings,
        "notes": found.notes,
    }


def write_json(path: Path, content: object) -> None:
    write_bytes(path, (json.dumps(content, indent=1) + "\n").encode())


def _without_flaws(quality: MotionQuality) -> dict[str, Any]:
    return {name: value for name, value in asdict(quality).items() if name != "flaws"}


def _clips(
    settings: BakeSettings, character: Character, loaded: Sequence[LoadedMotion]
) -> tuple[list[Clip], list[str]]:
    """The clips that splats and source are compared in, and notes: without any, a few that a bake makes for the rig."""
    if loaded or settings.motion_range == "none":
        return [motion.clip for motion in loaded], []
    return clips_of(replace(settings, student=replace(settings.student, frames=MADE)), character)


def _loaded(settings: BakeSettings, character: Character) -> list[LoadedMotion]:
    """The clips of the motions put on the character, else its own."""
    skeleton = character.skeleton
    if not settings.motions:
        matches = match_joints(skeleton, skeleton)
        return [LoadedMotion(clip, SourceMotion(skeleton, clip), matches, ()) for clip in character.clips]
    return [
        motion
        for path in settings.motions
        for motion in load_motions(
            path,
            skeleton,
            mapping=settings.mapping,
            rate=RATE,
            roles=character.roles,
            feet=settings.feet,
            refuse=False,
            face=character.expression_names,
        )
    ]


def _quality(settings: BakeSettings, character: Character, motion: LoadedMotion) -> MotionQuality:
    """What a clip keeps of its source; a character's own clip is its source."""
    if settings.motions:
        return measure_motion(motion.source, character.skeleton, motion.clip, motion.matches)
    return MotionQuality(motion.clip.name, 0.0, None, None, None, {}, None, {}, (), ())


def _notes(loaded: Sequence[LoadedMotion]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(note for motion in loaded for note in motion.notes))


def _refusals(settings: BakeSettings, character: Character, loaded: Sequence[LoadedMotion]) -> tuple[str, ...]:
    """Why a bake would refuse the motions, each reason once."""
    found = []
    for motion in loaded if settings.motions and not settings.mapping else ():
        try:
            require_limbs(motion.source.skeleton, character.skeleton, motion.matches)
        except InputError as error:
            found.append(str(error))
    return tuple(dict.fromkeys(found))


def _matched(character: Character, loaded: Sequence[LoadedMotion]) -> tuple[tuple[JointPair, ...], tuple[str, ...]]:
    """The pairs of the motion that moves most joints, and the joints with skin that it leaves still."""
    most = max(loaded, key=lambda motion: len(motion.matches.chains))
    carrying = np.unique(character.skin_indices[character.skin_weights > 0])
    pairs = joint_pairs(most.source.skeleton, character.skeleton, most.matches)
    return pairs, unmatched_target(character.skeleton, most.matches, carrying)
