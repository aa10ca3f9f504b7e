"""The rig of a character's file, for teachers that were trained on it."""

from collections.abc import Sequence
from typing import get_args

from mua.arguments import PathLike, as_path, describe, whole_number
from mua.atlas.uv import UvMode
from mua.channels import COARSE_TEXELS
from mua.characters.figure_size import LEAST, MOST, FigureSize
from mua.characters.read import read_character
from mua.errors import InputError
from mua.extras import naming_extras
from mua.rig.build import build_rig
from mua.rig.rig import Rig

PICTURE = 64  # texels of the atlas along a side: a rig has no colours


def load_rig(
    character: PathLike,
    *,
    texels: int = 768,
    vertices: int | None = None,
    uv: UvMode = "keep",
    height: float | None = None,
    leave_out: Sequence[str] = (),
) -> Rig:
    """The rig of a rigged character's file (FBX, glTF, VRM, USD or Skeletool), as a `TeacherWriter` takes it.

    `texels` is the size of the teacher's texture along a side, a multiple of 16. The template is the file's own mesh,
    one vertex for each place on the surface, or is simplified to about `vertices`. UVs stay as they are; with
    `uv="auto"` charts that overlap are cut anew. `height` in metres is for files whose unit is wrong, and `leave_out`
    names meshes, nodes or materials that are no part of the figure.

    Errors: InputError that names file, field and value.

    Example:

        rig = mua.load_rig("hero.glb", texels=384)
        with mua.TeacherWriter("recordings/hero", rig, rate=30) as writer: ...
    """
    path, size = as_path(character, "character"), whole_number(texels, "texels")
    if size <= 0 or size % COARSE_TEXELS:
        raise InputError(f"texels is {size}, expected a multiple of {COARSE_TEXELS}")
    wanted = None if vertices is None else whole_number(vertices, "vertices")
    if wanted is not None and wanted < 3:
        raise InputError(f"vertices is {wanted}, expected at least 3")
    if uv not in get_args(UvMode):
        raise InputError(f"uv is {describe(uv)}; expected {', '.join(get_args(UvMode))}")
    if height is not None and not LEAST <= height <= MOST:
        raise InputError(f"height is {describe(height)}; expected {LEAST:g} to {MOST:g} metres")
    figure = FigureSize(height=height)
    with naming_extras("mua.load_rig"):
        read = read_character(path, uv=uv, atlas_size=PICTURE, size=figure, leave_out=leave_out)
        return build_rig(read, texels=size, template_vertices=wanted or len(read.mesh.vertices))[0]
