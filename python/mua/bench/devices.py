"""Devices for the frame model: published figures, and assumptions where nothing is published."""

from dataclasses import dataclass

from mua.errors import InputError


@dataclass(frozen=True)
class Range:
    """An uncertain number between two bounds."""

    best: float  # makes the frame shortest
    likely: float
    worst: float


@dataclass(frozen=True)
class ModelDevice:
    """The rates that decide how long a frame takes."""

    title: str
    bandwidth: float  # memory bandwidth, GB/s
    copy: Range  # share of it that kernels reach
    peak: float  # TFLOPS, float32, a multiply-add as two
    compute: Range  # share of it that kernels reach
    shading: Range  # share of half the rate, as instructions, that fragments reach
    clock: float  # GHz
    triangles: Range  # per clock
    pixels: Range  # blended per clock
    passes: int  # passes over the triangles: two where one sorts them into tiles
    rest: Range  # milliseconds of a frame for everything else: render pipeline, resolve
    sources: tuple[str, ...]
    assumed: str  # figures without a source


DEVICES = {
    "quest3": ModelDevice(
        title="Meta Quest 3 (Adreno 740)",
        bandwidth=64,
        copy=Range(0.65, 0.48, 0.35),
        peak=3.1,
        compute=Range(0.25, 0.065, 0.04),
        shading=Range(0.8, 0.5, 0.25),
        clock=0.599,
        triangles=Range(2, 1, 0.5),
        pixels=Range(48, 24, 12),
        passes=2,
        rest=Range(1, 2, 3),
        sources=(
            "599 MHz, without dynamic resolution 545: "
            "https://www.uploadvr.com/meta-quest-3-gpu-clock-speed-performance-boost/",
            "the highest level needs dynamic resolution: "
            "https://developers.meta.com/horizon/documentation/native/android/po-quest-boost",
            "64 GB/s: https://nanoreview.net/en/soc/qualcomm-snapdragon-8-gen-2",
            "3.7 TFLOPS at 719 MHz, here at 599 MHz: https://primua.com/adreno-740/",
            "48 % of the bandwidth in a copy, of an Adreno X1: https://github.com/krrishnarraj/clpeak/issues/210",
            "0.2 TFLOPS of plain kernels: https://github.com/ggml-org/llama.cpp/pull/10693",
        ),
        assumed="triangles and pixels a clock, share of the instructions in fragments, 2 ms for the rest",
    ),
    "adreno-x2": ModelDevice(
        title="Snapdragon X2 Elite Extreme (Adreno X2-90)",
        bandwidth=228,
        copy=Range(0.65, 0.48, 0.35),
        peak=7.6,
        compute=Range(0.25, 0.065, 0.04),
        shading=Range(0.8, 0.5, 0.25),
        clock=1.85,
        triangles=Range(4, 2, 1),
        pixels=Range(64, 48, 24),
        passes=2,
        rest=Range(0.3, 0.7, 1.5),
        sources=(
            "1.85 GHz: https://technical.city/en/video/Radeon-R5-Carrizo-vs-Qualcomm-Adreno-X2-90",
            "228 GB/s; 2048 ALUs, hence 7.6 TFLOPS: "
            "https://www.notebookcheck.it/Adreno-X2-la-GPU-Snapdragon-X2-Elite-brilla-nei-benchmark-di-primo-livello.1166570.0.html",
            "48 % of the bandwidth in a copy, of an Adreno X1: https://github.com/krrishnarraj/clpeak/issues/210",
            "2 triangles and 48 pixels a clock, of an Adreno X1: "
            "https://hothardware.com/reviews/snapdragon-x-oryon-cpu-and-adreno-gpu-architecture?page=2",
        ),
        assumed="share of the operations in kernels (as a Quest 3's) and in fragments, the rest of a frame",
    ),
    "rtx3090": ModelDevice(
        title="GeForce RTX 3090",
        bandwidth=936,
        copy=Range(0.95, 0.85, 0.7),
        peak=35.6,
        compute=Range(0.4, 0.15, 0.05),
        shading=Range(0.8, 0.5, 0.25),
        clock=1.695,
        triangles=Range(7, 4, 2),
        pixels=Range(112, 112, 56),
        passes=1,
        rest=Range(0.2, 0.5, 1),
        sources=(
            "35.6 TFLOPS, 1.695 GHz, 112 render outputs: https://chipversus.com/hardware/gpu/geforce-rtx-3090",
            "936 GB/s: https://holynerdvana.blogspot.com/2022/10/nvidia-geforce-rtx-3090-specifications.html",
        ),
        assumed="all shares, triangles a clock, the rest of a frame",
    ),
}


def model_device(name: str) -> ModelDevice:
    """The device of this name; raises InputError where there is none."""
    if name not in DEVICES:
        raise InputError(f"--model is {name!r}; expected one of {', '.join(DEVICES)}")
    return DEVICES[name]
