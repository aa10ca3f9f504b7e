"""The kinds of exported files: their endings and what they hold."""

from dataclasses import dataclass
from pathlib import Path

from mua.arguments import listed
from mua.errors import InputError

SPLATS, MESH, GEOMETRY, SKELETON = "splats", "mesh", "geometry", "skeleton"
WHATS = (SPLATS, MESH, GEOMETRY, SKELETON)


@dataclass(frozen=True)
class Kind:
    """A kind of file."""

    suffix: str
    what: str
    clip: bool  # whether one file holds all frames


PACKAGE = ".usdz"  # with the texture of the mesh
USD = (".usd", ".usda", ".usdc", PACKAGE)
KINDS = (  # the default of each ending comes first
    Kind(".compressed.ply", SPLATS, clip=False),
    Kind(".ply", SPLATS, clip=False),
    Kind(".spz", SPLATS, clip=False),
    Kind(".glb", MESH, clip=True),
    Kind(".glb", SKELETON, clip=True),
    Kind(".glb", GEOMETRY, clip=False),
    Kind(".glb", SPLATS, clip=False),
    *(Kind(suffix, what, clip=True) for suffix in USD for what in (MESH, SKELETON, GEOMETRY, SPLATS)),
    Kind(".bvh", SKELETON, clip=True),
)
ENDINGS = tuple(dict.fromkeys(kind.suffix for kind in KINDS))
IN_DIRECTORY = ".ply"  # where the output is a directory


def kind_of(output: Path, what: str | None) -> Kind:
    """The kind of file that a name asks for; raises InputError for an unknown ending or one that cannot hold `what`."""
    suffix = suffix_of(output)
    kinds = [kind for kind in KINDS if kind.suffix == suffix]
    fitting = [kind for kind in kinds if what in (None, kind.what)]
    if not fitting:
        held = listed([kind.what for kind in kinds])
        raise InputError(f"--what is {what!r}; a {suffix} file holds {held}")
    return fitting[0]


def suffix_of(output: Path) -> str:
    """The ending that says which format; that of the files in a directory where `output` is to be one."""
    if is_directory(output):
        return IN_DIRECTORY
    found = next((suffix for suffix in ENDINGS if output.name.lower().endswith(suffix)), None)
    if found is None:
        raise InputError(f"-o is {output}; expected a directory or a name that ends in {listed(ENDINGS)}")
    return found


def is_directory(output: Path) -> bool:
    """Whether frames are to be written into a directory of that name."""
    return output.is_dir() or not output.suffix
