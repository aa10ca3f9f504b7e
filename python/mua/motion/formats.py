"""Which files hold motion, by their names and first bytes; asked first, so that a wrong one costs no time."""

from pathlib import Path

from mua.characters.formats import ANIMATIONS, require_scene
from mua.errors import InputError
from mua.files.signature import refuse_foreign, require_kind

SUFFIXES = (".bvh", ".npz", *ANIMATIONS)

FACES = (".csv", ".json")  # of a face alone: Live Link Face, Audio2Face
SAVE_NPZ = (
    "save its poses (or global_orient and body_pose), trans and mocap_framerate with numpy.savez, and give that .npz"
)
ADVICE = {  # for other kinds of motion files
    **dict.fromkeys(
        (".pkl", ".pickle", ".pt", ".pth"), f"opening it may run code; where you trust it, open it and {SAVE_NPZ}"
    ),
    ".npy": f"it holds one array without names; if that is rotations of SMPL, {SAVE_NPZ}; places of joints, as in "
    "HumanML3D, need a body model fitted to them first",
    ".trc": "pose the character by its keypoints with mua-capture poses, and give that .npz",
    ".json": "of 3D keypoints of EasyMocap or OpenPose, mua-capture poses makes an .npz of them; of SMPL's poses, "
    + SAVE_NPZ,
    **dict.fromkeys((".h5", ".hdf5", ".parquet"), f"of SMPL's poses, {SAVE_NPZ}"),
    **dict.fromkeys((".c3d", ".tsv"), "markers have no joints; solve a skeleton and export it as BVH"),
    **dict.fromkeys((".mvnx", ".mvn"), "export it from Xsens MVN as BVH or FBX"),
    ".tak": "export it from OptiTrack Motive as BVH or FBX",
    **dict.fromkeys((".x2d", ".vsk", ".mcp"), "export it from Vicon Shogun or Blade as FBX"),
    **dict.fromkeys((".mot", ".sto"), "export it from OpenSim as .trc, of which mua-capture poses makes an .npz"),
    **dict.fromkeys((".anim", ".unitypackage", ".prefab"), "export it from Unity as FBX"),
    ".bip": "load it on a Biped in 3ds Max and export that as FBX",
    ".duf": "export it from Daz Studio as FBX or BVH",
    **dict.fromkeys((".rbxm", ".rbxmx"), "export it from Roblox Studio by way of Blender as glTF"),
    **dict.fromkeys((".zip", ".gz", ".bz2", ".xz", ".tar", ".7z", ".rar"), "unpack it first"),
    **dict.fromkeys(
        (".mp4", ".mov", ".avi", ".webm", ".mkv", ".gif"),
        "it is a video; estimate the person's poses in it, such as with GVHMR, and save them as .npz",
    ),
    ".csv": "one of Live Link Face holds a face alone (mua-bake --face); of markers, solve a skeleton and export a BVH",
    **dict.fromkeys(
        (".vmd", ".vpd"),
        "import it in Blender on a model of MikuMikuDance (by the add-on mmd_tools), bake the legs' "
        "constraints and export it as BVH",
    ),
    **dict.fromkeys((".asf", ".amc", ".htr"), "import it in Blender or MotionBuilder and export it as BVH"),
}


def files_of(directory: Path) -> list[Path]:
    """The motion files of a directory, by name."""
    return sorted(file for file in directory.iterdir() if file.suffix.lower() in SUFFIXES)


def require_format(path: Path, others: tuple[str, ...] = ()) -> None:
    """Raises InputError where a path is no file of `SUFFIXES` by name and first bytes, and no directory of them.

    `others` are suffixes that its caller reads besides.
    """
    if path.is_dir():
        if not files_of(path):
            for file in sorted(path.iterdir()):
                _advise(file)
            raise InputError(f"{path}: expected files that end in {', '.join(SUFFIXES)}, found none")
        for file in files_of(path):
            require_format(file)
        return
    if not path.exists():
        raise InputError(f"{path}: does not exist, expected a motion file or a directory of them")
    suffix = path.suffix.lower()
    if suffix in ANIMATIONS:
        require_scene(path, ANIMATIONS)
        return
    if suffix == ".bvh":
        require_kind(path, "a BVH motion file", kinds=("a BVH motion file",))
        return
    if suffix == ".npz":
        require_kind(path, "an AMASS archive", kinds=("a ZIP archive",))
        return
    refuse_foreign(path)
    _advise(path)
    raise InputError(f"{path}: expected a suffix out of {', '.join((*others, *SUFFIXES))}, found {path.suffix!r}")


def _advise(path: Path) -> None:
    """Raise an InputError that says how to convert a file, where it is of another kind of motion."""
    if advice := ADVICE.get(path.suffix.lower()):
        raise InputError(f"{path}: {path.suffix} files are not read: {advice}")


def require_face(face: Path) -> None:
    """Raises InputError for a file that is not there or of a format that holds no face."""
    if not face.is_file():
        raise InputError(f"--face {face}: there is no such file")
    if face.suffix.lower() not in FACES:
        require_format(face, FACES)
