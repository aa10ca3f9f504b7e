"""What the systems of the paper's tables are called; needs no torch, so that a command can offer them at once."""

ALL = "all"
SYSTEM_NAMES = (
    "pca-only",
    "single-level",
    "2d-conv+2d-conv",
    "2d-conv+blendshapes",
    "blendshapes+1d-conv",
    "full-blendshapes",
    "linear",
    "ours",
)
