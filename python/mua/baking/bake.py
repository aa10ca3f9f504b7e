"""mua.bake: a rigged character and its motion become a verified `.muaavatar`, in one call."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any

from mua.arguments import PathLike
from mua.atlas.detail import UvMode
from mua.baking.listener import Listener, Log
from mua.baking.options import bake_settings
from mua.baking.settings import BakeSettings, MotionRange
from mua.baking.shared_options import (
    ClipsOption,
    DeviceOption,
    MegabytesOption,
    MflopOption,
    OutputOption,
    PresetOption,
    RecipeOption,
    SeedOption,
    StorageOption,
    TexelsOption,
)
from mua.characters.facing import Direction
from mua.extras import naming_extras
from mua.motion.planted_feet import Feet
from mua.option import Option, read_options

if TYPE_CHECKING:  # torch takes seconds to load
    from mua.baking.distillation import Baked


def bake(
    character: Annotated[
        PathLike | None,
        Option(
            "Rigged character: .fbx, .glb, .gltf, .vrm, .usd, .usda, .usdc, .usdz or .character; "
            "or the folder of a capture.",
            default="a built-in procedural character",
            metavar="CHARACTER",
        ),
    ] = None,
    *,
    teacher: Annotated[
        PathLike | None, Option("Folder that mua-teach wrote, to distil instead of a character.", default="none")
    ] = None,
    motion: Annotated[
        PathLike | Sequence[PathLike],
        Option(
            "Motion file, or folder of motion files; may be repeated. Where a capture is given, its own motion "
            "is recorded too.",
            default="the character's own clips",
        ),
    ] = (),
    face: Annotated[
        PathLike | None,
        Option(
            "Facial motion for all clips: a .csv of Live Link Face, a .json of Audio2Face, or a motion file.",
            default="that of the motion",
        ),
    ] = None,
    output: OutputOption = "avatar.muaavatar",
    preset: PresetOption = "preview",
    frames: Annotated[
        int | None,
        Option(
            "Number of training frames to record; a quarter as many held-out frames, at most 200, are added.",
            default="set by the preset",
            least=1,
        ),
    ] = None,
    texels: TexelsOption = None,
    budget_mflop: MflopOption = None,
    budget_mb: MegabytesOption = None,
    hold_out: Annotated[
        str | Sequence[str],
        Option("Clip to keep out of training, to measure errors on; may be repeated.", default="the end of every clip"),
    ] = (),
    clips: ClipsOption = "all",
    leave_out: Annotated[
        str | Sequence[str],
        Option("Mesh, node or material of the character file to leave out; may be repeated."),
    ] = (),
    alpha: Annotated[
        Mapping[str, str] | Sequence[str],
        Option(
            "How a material is transparent, where the file is wrong, such as hair=cut; may be repeated. "
            "opaque, cut (solid or clear), blend, or skip to leave it out.",
            default="as the file says",
        ),
    ] = (),
    expression_names: Annotated[
        PathLike | Mapping[str, str] | None,
        Option("JSON file that gives expressions of the character other names.", default="as the file calls them"),
    ] = None,
    smplx: Annotated[
        PathLike | None,
        Option("Model file (.npz) of SMPL-X, whose expressions a character of its mesh gets.", default="none"),
    ] = None,
    mapping: Annotated[
        PathLike | Mapping[str, str] | None,
        Option(
            "JSON or TOML file that gives, for joints of the character, the joint of the motion.",
            default="matched by name",
        ),
    ] = None,
    feet: Annotated[
        Feet,
        Option("Whether standing feet are held in place: auto (if they would slide), keep (never) or plant (always)."),
    ] = "auto",
    motion_range: Annotated[
        MotionRange,
        Option("Whether a built-in range of motion is trained on beside the character's motion: full or none."),
    ] = "full",
    uv: Annotated[UvMode, Option("Keep the character's UVs, unwrap new ones, or choose automatically.")] = "auto",
    detail: Annotated[
        Mapping[str, float] | Sequence[str],
        Option(
            "Resolution of a body part relative to the others, such as head=2; may be repeated. "
            "Parts: head, hands, arms, body, legs, feet."
        ),
    ] = (),
    scale: Annotated[float | None, Option("Factor by which to multiply the size in the character file.")] = None,
    height: Annotated[float | None, Option("Height to scale the character to, in metres.")] = None,
    facing: Annotated[
        Direction | None,
        Option(
            "Direction in which the character faces in its file, Y up: +x, -x, +z or -z.",
            default="recognised from its body and motion",
        ),
    ] = None,
    turn: Annotated[
        float, Option("Degrees by which to turn the character about its vertical axis, from +Z towards +X.")
    ] = 0.0,
    recipe: RecipeOption = "closed-form",
    storage: StorageOption = "f16",
    seed: SeedOption = 0,
    device: DeviceOption = "auto",
    jobs: Annotated[int | None, Option("Number of processes that record.", default="one per CPU core", least=1)] = None,
    work: Annotated[
        PathLike | None, Option("Folder for the recording and checkpoints.", default="beside the output")
    ] = None,
    listener: Listener | None = None,
) -> "Baked":
    """Record a teacher of `character`, distil it and write a `.muaavatar`, as mua-bake does: minutes to hours.

    The arguments are the options of mua-bake (docs/bake.md) by the same names, and their errors name the options. Where
    an option may be repeated, one value or several are given; `mapping` and `expression_names` are files or
    dictionaries, `detail` and `alpha` dictionaries such as `{"head": 2}`. Without a `character` the procedural one is
    baked; where it is the folder of a capture, a teacher is trained first, and a `teacher` is the folder that
    `mua.teach` wrote. A call that was interrupted goes on where it stopped when the same one is made again.

    `listener` receives stages, steps and notes; without one they go to the log "mua" of Python's logging.

    Errors: InputError for anything that cannot be used; ModuleNotFoundError, with what to install, without the packages
    of the extra `bake`.

    Example:

        baked = mua.bake("hero.glb", motion="walks", preset="tiny", output="hero.muaavatar")
        baked.errors["training"].explained("SH")
    """
    given = locals()
    with naming_extras("mua.bake"):
        settings = read_settings(given)
        from mua.baking import pipeline  # seconds of loading: only once the options are known to be good

        return pipeline.bake(settings, listener or Log())


def read_settings(given: Mapping[str, Any]) -> BakeSettings:
    """The settings that the arguments of `bake`, all of them, ask for; raises InputError for wrong ones."""
    return bake_settings(read_options(bake, given))
