"""The measurements as JSON."""

from dataclasses import asdict
from typing import Any

from mua.bench.measure import Measured
from mua.bench.work import Work


def rate(amount: int, milliseconds: float) -> float:
    """Amount per second; 0 where the device's clock saw no time pass."""
    return amount / (1e-3 * milliseconds) if milliseconds > 0 else 0.0


def total_work(measured: Measured) -> Work:
    return sum(measured.work.values(), Work(0, 0))


def total_milliseconds(measured: Measured) -> float:
    """The sum of the kernels' medians: a frame from pose to sorted splats."""
    return sum(timing.median for timing in measured.kernels.values())


def as_json(measured: Measured) -> dict[str, Any]:
    """Numbers and names only; units are in the names."""
    return {
        "device": measured.device,
        "avatar": measured.avatar,
        "splats": measured.splats,
        "visible_splats": measured.visible,
        "screen_pixels": list(measured.screen),
        "eyes": measured.eyes,
        "frames": measured.frames,
        "copy_bytes_per_second": measured.copy_bandwidth,
        "kernels": {name: _kernel(measured, name) for name in measured.kernels},
        "compute_milliseconds": total_milliseconds(measured),
        "draw_milliseconds": asdict(measured.draw),
    }


def _kernel(measured: Measured, name: str) -> dict[str, Any]:
    timing, work = measured.kernels[name], measured.work[name]
    moved = rate(work.bytes, timing.median)
    return {
        "milliseconds": asdict(timing),
        "bytes": work.bytes,
        "flops": work.flops,
        "bytes_per_second": moved,
        "flops_per_second": rate(work.flops, timing.median),
        "fraction_of_copy": moved / measured.copy_bandwidth,
    }
