"""MUA: an open pipeline and player for photoreal, animatable human avatars.

Reading an avatar, decoding and drawing it on the CPU:

    import mua

    avatar = mua.load("hero.muaavatar")
    splats = avatar.decode("walk", 12)
    mua.render(splats).save("hero.png")

Names are loaded when they are first used: `import mua` is quick, and the lines above need numpy, flatbuffers and pillow
alone. Bad input raises `InputError` with a sentence; a missing package raises `ModuleNotFoundError`
with what to install.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from mua.errors import InputError
from mua.extras import naming_extras
from mua.version import __version__ as __version__

if TYPE_CHECKING:
    from mua.asset.avatar import Avatar
    from mua.asset.read import read as load
    from mua.asset.write import write as save
    from mua.avatar.camera import Camera
    from mua.avatar.decode import Splats
    from mua.avatar.rendering import render
    from mua.baking.bake import bake
    from mua.baking.teach import teach
    from mua.baking.train import train
    from mua.characters.load import load_rig
    from mua.pose.clip import Clip
    from mua.pose.skeleton import Pose
    from mua.recording import Recording, TeacherWriter

__all__ = [
    "Avatar",
    "Camera",
    "Clip",
    "InputError",
    "Pose",
    "Recording",
    "Splats",
    "TeacherWriter",
    "bake",
    "load",
    "load_rig",
    "render",
    "save",
    "teach",
    "train",
]

_PLACES = {
    "Avatar": "mua.asset.avatar:Avatar",
    "Camera": "mua.avatar.camera:Camera",
    "Clip": "mua.pose.clip:Clip",
    "Pose": "mua.pose.skeleton:Pose",
    "Recording": "mua.recording:Recording",
    "Splats": "mua.avatar.decode:Splats",
    "TeacherWriter": "mua.recording:TeacherWriter",
    "bake": "mua.baking.bake:bake",
    "load": "mua.asset.read:read",
    "load_rig": "mua.characters.load:load_rig",
    "render": "mua.avatar.rendering:render",
    "save": "mua.asset.write:write",
    "teach": "mua.baking.teach:teach",
    "train": "mua.baking.train:train",
}


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name not in _PLACES:
        raise AttributeError(f"module 'mua' has no attribute {name!r}")
    module, _, attribute = _PLACES[name].partition(":")
    with naming_extras(f"mua.{name}"):
        globals()[name] = value = getattr(import_module(module), attribute)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
