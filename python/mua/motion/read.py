"""Read motion of any known format, from a file or all files of a directory."""

from pathlib import Path

from mua.errors import InputError
from mua.motion.amass import read_amass
from mua.motion.bvh import read_bvh
from mua.motion.formats import files_of, require_format
from mua.motion.poses_file import holds_poses, read_poses
from mua.motion.source_motion import SourceMotion


def read_motion(path: Path) -> list[SourceMotion]:
    """Read every motion of `path`: one file of `SUFFIXES`, or those of a directory by name.

    Errors: InputError for a path that does not exist, a suffix that is not known, a file or directory without motion.
    """
    require_format(path)
    if path.is_dir():
        return [motion for file in files_of(path) for motion in read_motion(file)]
    suffix = path.suffix.lower()
    if suffix == ".bvh":
        return [read_bvh(path)]
    if suffix == ".npz":
        return [read_poses(path) if holds_poses(path) else read_amass(path)]
    return _read_rig_clips(path)


def _read_rig_clips(path: Path) -> list[SourceMotion]:
    from mua.characters.read import read_animation  # here, because scene readers are slow to import

    animation = read_animation(path)
    if not animation.clips:
        raise InputError(f"{path}: expected an animation, found none")
    shared = (animation.notes, animation.roles, animation.expressions)
    return [SourceMotion(animation.skeleton, clip, *shared) for clip in animation.clips]
