"""Which optional packages of the installation each command needs."""

EXTRAS = {  # of python/pyproject.toml: the names under which the packages that each brings are imported
    "view": ("glfw", "imageio_ffmpeg", "imgui_bundle", "pywt", "rendercanvas", "scipy", "wgpu", "xatlas"),
    "train": ("meshoptimizer", "moderngl", "pywt", "scipy", "torch", "xatlas"),
    "bake": ("DracoPy", "meshoptimizer", "moderngl", "pxr", "pygltflib", "pywt", "scipy", "torch", "warp", "xatlas"),
    "eval": ("flip_evaluator", "matplotlib", "torchmetrics"),
    "deploy": ("adbutils",),
}
OF_COMMAND = {"mua-bench": "view"}  # where it is not the command's own name


def missing_package(command: str, module: str) -> str | None:
    """The sentence for a package that is not installed; None where no extra brings it."""
    package = module.partition(".")[0]
    bringing = [extra for extra, packages in EXTRAS.items() if package in packages]
    if not bringing:
        return None
    own = OF_COMMAND.get(command, command.removeprefix("mua-"))
    extra = own if own in EXTRAS else bringing[0]
    wanted = extra if package in whole(extra) else ",".join((extra, bringing[0]))
    return f'{command} needs the Python package {package}, which is not installed: pip install "mua[{wanted}]"'


def whole(extra: str) -> set[str]:
    """All that an extra brings, with the extras that it includes."""
    included = ("view", "train") if extra == "eval" else ()
    return {package for name in (extra, *included) for package in EXTRAS[name]}
