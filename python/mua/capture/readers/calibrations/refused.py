"""Calibrations and data sets that are not read, and what to do with them."""

from pathlib import Path

from mua.errors import InputError

BY_HAND = "write OpenCV's matrices of each camera to intri.yml and extri.yml, as EasyMocap names them"
COLMAP = "export COLMAP's cameras.txt and images.txt"
PICKLED = f"it is pickled, and opening it may run code; where you trust it, {BY_HAND}"
DATA_SETS = (  # patterns of files, what has them, and the way out
    ("annots.npy", "ZJU-MoCap", PICKLED),
    ("cameras.pkl", "4D-Dress", PICKLED),
    ("*.smc", "DNA-Rendering", f"unpack images and masks with its SMCReader, and {BY_HAND}"),
    ("*.hdf5", "PeopleSnapshot", "a capture needs several cameras that stand still"),
)
PROGRAMS = (
    ("*.sfm", "Meshroom", f"{COLMAP} with aliceVision_exportColmap"),
    ("*.xml", "Metashape", f"{COLMAP} there (File, Export, Export Cameras)"),
    ("*.csv", "RealityCapture", f"{COLMAP} there (Registration), with undistorted images"),
    ("*.xmp", "RealityCapture", f"{COLMAP} there (Registration), with undistorted images"),
    ("*.xcp", "Vicon", BY_HAND),
    ("*.mat", "MATLAB", BY_HAND),
    ("*.json", "another program", BY_HAND),
    ("*.pkl", "Python", PICKLED),
    *((f"*.{suffix}", "OpenCV or numpy", BY_HAND) for suffix in ("yml", "yaml", "npz", "npy")),
)


def refuse_others(path: Path) -> None:
    """Raises InputError, which says the way out, for another program's file, or for the folder of a data set."""
    for pattern, maker, advice in DATA_SETS if path.is_dir() else (*DATA_SETS, *PROGRAMS):
        inside = sorted((*path.glob(pattern), *path.glob(f"*/{pattern}")))
        if found := inside or [one for one in [path] if one.match(pattern)]:
            raise InputError(f"{found[0]}: looks like {maker}'s, which is not read; {advice}")
