"""Read motion of any known format, from a file or all files of a directory."""

from pathlib import Path

from mua.errors import InputError
from mua.motion.amass import read_amass
from mua.motion.bvh import read_bvh
from mua.motion.poses_file import holds_poses, read_poses
from mua.motion.source import SourceMotion
from mua.signature import refuse_foreign, require_kind

RIG_SUFFIXES = (".glb", ".gltf", ".vrm", ".vrma", ".usd", ".usda", ".usdc", ".usdz", ".motion")
SUFFIXES = (".bvh", ".npz", *RIG_SUFFIXES)


SAVE_NPZ = "save its poses, trans and mocap_framerate with numpy.savez, and give that .npz"
ADVICE = {  # for other kinds of motion files
    **dict.fromkeys(
        (".pkl", ".pickle", ".pt", ".pth"), f"opening it may run code; where you trust it, open it and {SAVE_NPZ}"
    ),
    ".npy": f"it holds one array without names; {SAVE_NPZ}",
    **dict.fromkeys((".c3d", ".trc", ".csv", ".tsv"), "markers have no joints; solve a skeleton and export it as BVH"),
    **dict.fromkeys((".asf", ".amc", ".htr", ".vmd"), "import it in Blender or MotionBuilder and export it as BVH"),
}


def read_motion(path: Path) -> list[SourceMotion]:
    """Read every motion of `path`: one file of `SUFFIXES`, or those of a directory by name.

    Errors: InputError for a path that does not exist, a suffix that is not known, a file or directory without motion.
    """
    if path.is_dir():
        files = sorted(file for file in path.iterdir() if file.suffix.lower() in SUFFIXES)
        if not files:
            raise InputError(f"{path}: expected files that end in {', '.join(SUFFIXES)}, found none")
        return [motion for file in files for motion in read_motion(file)]
    if not path.exists():
        raise InputError(f"{path}: does not exist, expected a motion file or a directory of them")
    suffix = path.suffix.lower()
    if suffix == ".bvh":
        require_kind(path, "a BVH motion file", kinds=("a BVH motion file",))
        return [read_bvh(path)]
    if suffix == ".npz":
        require_kind(path, "an AMASS archive", kinds=("a ZIP archive",))
        return [read_poses(path) if holds_poses(path) else read_amass(path)]
    if suffix in RIG_SUFFIXES:
        return _read_rig_clips(path)
    refuse_foreign(path)
    if suffix in ADVICE:
        raise InputError(f"{path}: {path.suffix} files are not read: {ADVICE[suffix]}")
    raise InputError(f"{path}: expected a suffix out of {', '.join(SUFFIXES)}, found {path.suffix!r}")


def _read_rig_clips(path: Path) -> list[SourceMotion]:
    from mua.characters.read import read_animation  # here, because scene readers are slow to import

    animation = read_animation(path)
    if not animation.clips:
        raise InputError(f"{path}: expected an animation, found none")
    return [SourceMotion(animation.skeleton, clip, animation.notes, animation.roles) for clip in animation.clips]
