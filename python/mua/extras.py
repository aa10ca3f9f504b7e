"""Which optional packages each command, and the function of the same name, needs."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from mua.errors import InputError

# The extras of python/pyproject.toml, by the names under which their packages are imported.
READING = ("DracoPy", "meshoptimizer", "opengl_basisu", "pygltflib", "pywt", "scipy", "ufbx", "xatlas")
TRAINING = ("meshoptimizer", "moderngl", "pywt", "scipy", "threadpoolctl", "torch", "trimesh", "warp", "xatlas")
VIEWING = (*READING, "glfw", "imageio_ffmpeg", "imgui_bundle", "rendercanvas", "wgpu")
EXTRAS = {  # the smaller ones first: the first that brings a package is proposed
    "view": frozenset(VIEWING),
    "export": frozenset((*READING, "pxr")),
    "train": frozenset(TRAINING),
    "bake": frozenset((*READING, *TRAINING, "pxr")),
    "teach": frozenset((*READING, *TRAINING, "imageio_ffmpeg", "pxr", "torchmetrics")),
    "eval": frozenset((*VIEWING, *TRAINING, "flip_evaluator", "matplotlib", "torchmetrics")),
    "deploy": frozenset(("adbutils",)),
}
OF_COMMAND = {  # where the extra's name differs from that of the command or function
    "mua-bench": "view",
    "mua-capture": "view",
    "mua-share": "view",
    "mua.Recording": "train",
    "mua.TeacherWriter": "train",
    "mua.load_rig": "bake",
}
RESEARCH, IN_A_CHECKOUT = "mua_research", "pip install -e python/research in a checkout of MUA's repository"


def missing_package(command: str, module: str) -> str | None:
    """The sentence for a module that is not installed; None where no extra brings its package."""
    package = module.partition(".")[0]
    bringing = [extra for extra, packages in EXTRAS.items() if package in packages]
    if not bringing:
        return None
    own = OF_COMMAND.get(command, command[len("mua-") :])
    wanted = [own] if own in EXTRAS else []
    if own not in bringing:
        wanted.append(bringing[0])
    return f"{command} needs the Python package {package}, which is not here: {_install(','.join(wanted))}"


def require_research(option: str) -> None:
    """Raises InputError where the package of a checkout that trains other systems than ours is not installed."""
    if find_spec(RESEARCH) is None:
        checkout = _checkout()
        install = f'{sys.executable} -m pip install -e "{checkout}/research"' if checkout else IN_A_CHECKOUT
        raise InputError(f"{option}: needs the Python package {RESEARCH}, which is not here: {install}")


def _install(extras: str) -> str:
    """The command that installs extras: of the checkout that this runs from, where it does, by the same Python."""
    checkout = _checkout()
    return f'{sys.executable} -m pip install -e "{checkout}[{extras}]"' if checkout else f'pip install "mua[{extras}]"'


def _checkout() -> Path | None:
    """The folder of the package's project, where this runs from a checkout."""
    folder = Path(__file__).resolve().parents[1]
    return folder if (folder / "pyproject.toml").is_file() else None


@contextmanager
def naming_extras(function: str) -> Iterator[None]:
    """Say what to install where a module is missing that an extra brings; `function` is a public name, as mua.bake."""
    try:
        yield
    except ModuleNotFoundError as error:
        sentence = missing_package(function, error.name or "")
        if sentence is None:
            raise
        raise ModuleNotFoundError(sentence, name=error.name) from error
