"""Which optional packages of the installation each command, or function of the same name, needs."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

# The extras of python/pyproject.toml, by the names under which their packages are imported.
READING = ("DracoPy", "meshoptimizer", "pygltflib", "pywt", "scipy", "xatlas")
TRAINING = ("meshoptimizer", "moderngl", "pywt", "scipy", "torch", "trimesh", "warp", "xatlas")
VIEWING = (*READING, "glfw", "imageio_ffmpeg", "imgui_bundle", "rendercanvas", "wgpu")
EXTRAS = {  # the smaller ones first: of several that bring a package the first is proposed
    "view": frozenset(VIEWING),
    "export": frozenset((*READING, "pxr")),
    "train": frozenset(TRAINING),
    "bake": frozenset((*READING, *TRAINING, "pxr")),
    "teach": frozenset((*READING, *TRAINING, "imageio_ffmpeg", "pxr", "torchmetrics")),
    "eval": frozenset((*VIEWING, *TRAINING, "flip_evaluator", "matplotlib", "torchmetrics")),
    "deploy": frozenset(("adbutils",)),
}
OF_COMMAND = {  # where the extra is not called as the command or the function
    "mua-bench": "view",
    "mua-capture": "view",
    "mua-share": "view",
    "mua.Recording": "train",
    "mua.TeacherWriter": "train",
    "mua.load_rig": "bake",
}


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


def _install(extras: str) -> str:
    """The command that installs extras: of the checkout that this runs from, where it does, by the same Python."""
    checkout = Path(__file__).resolve().parents[1]
    if (checkout / "pyproject.toml").is_file():
        return f'{sys.executable} -m pip install -e "{checkout}[{extras}]"'
    return f'pip install "mua[{extras}]"'


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
