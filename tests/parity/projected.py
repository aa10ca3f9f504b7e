"""Packed splats through SplatProject, ScanCounts and SplatCompact on a device."""

from dataclasses import dataclass

import numpy as np
from packed_splats import covariance_of, unpacked

from mua.arrays import Array
from mua.camera import NEAR, Camera
from mua.gpu import Device, run

FILE = "splat_project.compute"
GROUP = 256  # threads
UNWRITTEN = 0xFFFFFFFF


@dataclass(frozen=True)
class Scene:
    """Packed splats before one or two eyes."""

    words: Array  # [N, 16] uint32
    cameras: tuple[Camera, ...]
    bounds: Array  # [2, 3]

    @property
    def constants(self) -> dict[str, int | float | Array]:
        eyes = [self.cameras[0], self.cameras[-1]]
        middle = np.mean([c.position for c in self.cameras], axis=0)
        return {
            "view": np.stack([c.view for c in eyes]),
            "projection": np.stack([c.projection for c in eyes]),
            "camera": np.append(middle, 0),
            "bounds_low": np.append(self.bounds[0], 0),
            "bounds_high": np.append(self.bounds[1], 0),
            "screen": np.array(self.cameras[0].screen),
            "near": NEAR,
            "eyes": len(self.cameras),
            "splat_count": len(self.words),
            "instances": 1,
        }

    def splats(self) -> tuple[Array, Array, Array]:
        """Centres, covariances and opacities in float64, as the GPU unpacks them."""
        fields = unpacked(self.words)
        return fields["centre"].astype(float), covariance_of(fields), fields["opacity"].astype(float)


@dataclass(frozen=True)
class Projected:
    """What the three kernels leave for the sort and the draw."""

    ellipses: Array  # [E, N, 6]
    colors: Array  # [N, 4] float16
    visible: Array  # [M]
    keys: Array  # [M]
    arguments: Array  # [8]


def project_on(device: Device, scene: Scene) -> Projected:
    count, eyes = len(scene.words), len(scene.cameras)
    groups = -(-count // GROUP)
    buffers = {
        "splats": scene.words,
        "ellipses": np.zeros((eyes, count, 6), np.float32),
        "colors": np.zeros((count, 4), np.float16),
        "flags": np.full(count, UNWRITTEN, np.uint32),
        "group_counts": np.full(groups, UNWRITTEN, np.uint32),
    }
    found = run(device, FILE, "SplatProject", (groups, 1, 1), buffers, **scene.constants)
    arguments, group_counts = scan_on(device, found["group_counts"], count)
    visible, keys = compact_on(device, found["flags"], group_counts)
    total = arguments[7]
    return Projected(found["ellipses"], found["colors"], visible[:total], keys[:total], arguments)


def scan_on(device: Device, group_counts: Array, count: int) -> tuple[Array, Array]:
    """Arguments [8] and the scanned counts from ScanCounts."""
    buffers = {"group_counts": group_counts, "arguments": np.full(8, UNWRITTEN, np.uint32)}
    found = run(device, FILE, "ScanCounts", (1, 1, 1), buffers, splat_count=count, instances=2)
    return found["arguments"], found["group_counts"]


def compact_on(device: Device, flags: Array, group_counts: Array) -> tuple[Array, Array]:
    """Visible splats and keys [N] from SplatCompact; behind the last, UNWRITTEN."""
    buffers = {
        "flags": flags,
        "group_counts": group_counts,
        "visible": np.full(len(flags), UNWRITTEN, np.uint32),
        "keys": np.full(len(flags), UNWRITTEN, np.uint32),
    }
    found = run(device, FILE, "SplatCompact", (len(group_counts), 1, 1), buffers, splat_count=len(flags))
    return found["visible"], found["keys"]
