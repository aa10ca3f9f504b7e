"""A rigged character and its motion become a verified `.muaavatar`, in one call."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mua.arguments import PathLike
from mua.asset.tensors import Storage
from mua.atlas.detail import UvMode
from mua.baking.listener import Listener, Log
from mua.baking.options import read_order
from mua.baking.order import DeviceName, MotionRange
from mua.extras import naming_extras
from mua.motion.planted_feet import Feet

if TYPE_CHECKING:  # torch takes seconds to load
    from mua.baking.distillation import Baked


def bake(
    character: PathLike | None = None,
    *,
    teacher: PathLike | None = None,
    motion: PathLike | Sequence[PathLike] = (),
    output: PathLike = "avatar.muaavatar",
    preset: str = "preview",
    frames: int | None = None,
    texels: int | None = None,
    hold_out: str | Sequence[str] = (),
    clips: str | int | Sequence[str] = "all",
    leave_out: str | Sequence[str] = (),
    mapping: PathLike | Mapping[str, str] | None = None,
    feet: Feet = "auto",
    motion_range: MotionRange = "full",
    uv: UvMode = "auto",
    detail: Mapping[str, float] | Sequence[str] = (),
    scale: float | None = None,
    height: float | None = None,
    recipe: str = "closed-form",
    storage: Storage = "f16",
    seed: int = 0,
    device: DeviceName = "auto",
    jobs: int | None = None,
    work: PathLike | None = None,
    listener: Listener | None = None,
) -> "Baked":
    """Record a teacher of `character`, distil it and write a `.muaavatar`, as mua-bake does: minutes to hours.

    The arguments are the options of mua-bake (docs/bake.md) by the same names, and their errors name the options. Where
    an option may be repeated, one value or several are given; `mapping` is a file or a dictionary, `detail` is a
    dictionary such as `{"head": 2}`. Without a `character` the procedural one is baked; where it is the folder of a
    capture, a teacher is taught first, and a `teacher` is the folder that `mua.teach` wrote. A call that was
    interrupted goes on where it stopped when the same one is made again.

    `listener` hears of stages, steps and notes; without one they go to the log "mua" of Python's logging.

    Errors: InputError for anything that cannot be used; ModuleNotFoundError, with what to install, without the packages
    of the extra `bake`.

    Example:

        baked = mua.bake("hero.glb", motion="walks", preset="tiny", output="hero.muaavatar")
        baked.errors["training"].explained("SH")
    """
    options = {name: value for name, value in locals().items() if name != "listener"}
    order = read_order(options)
    with naming_extras("mua.bake"):
        from mua.baking import pipeline  # seconds of loading: only once the options are known to be good

        return pipeline.bake(order, listener or Log())
