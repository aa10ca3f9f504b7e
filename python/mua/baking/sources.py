"""What a bake starts from: a character, and clips of motion on its skeleton."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Unpack

import numpy as np

from mua.asset.storable import require_names
from mua.atlas.character_surfaces import Surfaces
from mua.atlas.detail import Detail, UvMode
from mua.baking.settings import BakeSettings
from mua.characters.facing import AS_SHOWN
from mua.characters.figure_size import AS_FOUND, FigureSize
from mua.characters.messages import LOST, PLAIN, is_about, listed
from mua.characters.read import Reading, read_character
from mua.errors import InputError
from mua.motion.face import with_face
from mua.motion.load import counted, load_motions, unique_names
from mua.motion.planted_feet import Feet
from mua.motion.quality import measure_motion
from mua.motion.range import motion_range, standing
from mua.pose.clip import RANGE_OF_MOTION, Clip, show_one_pose
from mua.pose.encoding import RATE
from mua.pose.resample import resample
from mua.rig.character import Character

ATLAS = 1024  # texels of the base-colour atlas along a side


def load_baked_character(
    settings: BakeSettings, *, read: Callable[[Surfaces], None] = lambda surfaces: None
) -> Character:
    """The character of a bake or a check, with the layout and size that its settings ask for.

    `read` is called as by `read_character`.
    """
    character = load_character(
        settings.character,
        uv=settings.uv,
        seed=settings.student.seed,
        read=read,
        detail=settings.detail,
        size=settings.size,
        leave_out=settings.leave_out,
        alphas=settings.alphas,
        facing=settings.facing,
        expression_names=settings.expression_names,
        smplx=settings.smplx,
    )
    character = replace(character, notes=(*_one_coloured(character), *character.notes))
    return character if settings.motion_range == "none" else _without_still_clips(character)


def _one_coloured(character: Character) -> tuple[str, ...]:
    """A sentence where a character of a single colour has places for pictures, but none, and none is known as lost."""
    if character.source is None or any(is_about(note, LOST) for note in character.notes):
        return ()
    scene = character.source.scene
    used = sorted({part.material for part in scene.parts if len(part.faces)})
    materials = [scene.materials[m] for m in used]
    pictured = any(material.image.shape[:2] != (1, 1) for material in materials)
    placed = any((part.uv_faces >= 0).any() for part in scene.parts)
    if pictured or not placed or np.ptp(character.base_color, axis=(0, 1)).any():
        return ()
    return (PLAIN.format(listed([material.name for material in materials])),)


def _without_still_clips(character: Character) -> Character:
    """The character, as one without animation where its clips show one pose: programs write a rest pose as a take."""
    clips = character.clips
    if not clips or not show_one_pose(clips):
        return character
    note = f"{', '.join(clip.name for clip in clips)}: shows one pose, which counts as no animation."
    return replace(character, clips=(), notes=(*character.notes, note))


def load_character(
    path: Path | None,
    *,
    uv: UvMode,
    seed: int,
    detail: Detail | None = None,
    size: FigureSize = AS_FOUND,
    read: Callable[[Surfaces], None] = lambda surfaces: None,
    **reading: Unpack[Reading],
) -> Character:
    """The character in the file at `path` less what `leave_out` names, or the procedural one where no path is given.

    Errors: InputError where a size, a direction, an alpha or something to leave out is given for the procedural one,
    and for names that no avatar file may have.
    """
    if path is not None:
        character = read_character(path, uv=uv, atlas_size=ATLAS, detail=detail, size=size, read=read, **reading)
        require_names(str(path), [character.name], character.skeleton.names, ())
        return character
    if size != AS_FOUND:
        raise InputError("--scale and --height need a character from a file; give CHARACTER")
    if reading.get("facing", AS_SHOWN) != AS_SHOWN:
        raise InputError("--facing and --turn need a character from a file; give CHARACTER")
    if reading.get("expression_names") is not None:
        raise InputError("--expression-names: needs a character from a file; give CHARACTER")
    if (smplx := reading.get("smplx")) is not None:
        raise InputError(f"--smplx {smplx}: needs a character from a file; give CHARACTER")
    if leave_out := reading.get("leave_out"):
        raise InputError(f"--leave-out {leave_out[0]}: needs a character from a file; give CHARACTER")
    for name, alpha in reading.get("alphas", {}).items():
        raise InputError(f"--alpha {name}={alpha}: needs a character from a file; give CHARACTER")
    from mua.teachers.procedural import procedural_character  # not to be loaded for a file's sake

    return procedural_character(seed=seed)


def clips_of(settings: BakeSettings, character: Character) -> tuple[list[Clip], list[str]]:
    """The clips that a bake is of, and notes: those of the files, else the character's, else the range of motion."""
    if settings.motions or character.clips or settings.motion_range == "none":
        return load_clips(character, settings.motions, mapping=settings.mapping, feet=settings.feet)
    clips = motion_range(character, (), frames=settings.student.frames, seed=settings.student.seed, short=True)
    clips = [replace(clip, name=clip.name.removeprefix(RANGE_OF_MOTION)) for clip in clips]  # they are the motion
    clips = [*standing(character), *clips]  # players begin with the first
    note = f"{character.name}: holds no animation; its motion is a built-in range of motion made for its rig"
    return clips, [f"{note}. --motion adds motion of your own."]


def load_clips(
    character: Character,
    motions: Sequence[Path],
    *,
    mapping: Mapping[str, str] | None,
    feet: Feet = "auto",
) -> tuple[list[Clip], list[str]]:
    """The clips of `motions` put on the character, or the character's own; and notes on them.

    Clips of one name are numbered. Errors: InputError where there is no motion at all, and for names that no avatar
    file may have.
    """
    if not motions:
        if not character.clips:
            raise InputError(f"{character.name}: holds no animation; give a file or directory with --motion")
        require_names(character.name, (), (), [clip.name for clip in character.clips])
        return [resample(clip, RATE) for clip in character.clips], []
    clips: list[Clip] = []
    notes: list[str] = []
    for path in motions:
        for loaded in load_motions(
            path,
            character.skeleton,
            mapping=mapping,
            rate=RATE,
            roles=character.roles,
            feet=feet,
            face=character.expression_names,
        ):
            quality = measure_motion(loaded.source, character.skeleton, loaded.clip, loaded.matches)
            require_names(str(path), (), (), [loaded.clip.name])
            clips.append(loaded.clip)
            notes += (*loaded.notes, *quality.flaws)
    return unique_names(clips), list(counted(notes, clips))


def faced(
    character: Character,
    clips: Sequence[Clip],
    face: Path | None,  # facial motion; None: each clip has its own, if any
) -> tuple[list[Clip], list[str]]:
    """The clips with facial motion of a file of its own; and notes. Errors: InputError where there is no face."""
    if face is None:
        return list(clips), []
    if not character.expression_names:
        raise InputError(f"--face {face}: {character.name} has no expressions (morph targets) that it could move")
    return with_face(clips, face, character.expression_names)
