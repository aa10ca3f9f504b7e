"""All avatars' splats together: the dispatches from posed splats to those that one or two eyes see, back to front.

Kept a plain list in the order of the kernels, so that unity-package/Runtime/SplatFrame.cs reads line for line like it.
"""

from collections.abc import Sequence
from itertools import accumulate

import numpy as np

from mua.arrays import Array
from mua.camera import Camera
from mua.errors import InputError
from mua.gpu import Commands, Device
from mua.player.buffers import AvatarBuffers
from mua.player.draw import SortedSplats
from mua.player.frame import AvatarFrame, groups
from mua.rig.bounds import union

EYES = 2  # at most
FLOAT = 4  # bytes
PROJECTED = 256  # splats of a group of SplatProject and SplatCompact
SORTED = 2048  # keys of a group of the sort
DIGITS = 256  # values of 8 bits
DIGIT_SHIFTS = (0, 8)
SORT_ARGUMENTS = 16  # byte of `arguments` at which the group counts of the sort stand


class SplatFrame:
    """One sort for all avatars, so that those that stand among each other blend rightly.

    A splat's colour is computed once for both eyes, towards the mean of their positions: degree-1 harmonics turn with
    the direction, and two eyes 63 mm apart see an avatar a metre away in directions 4 degrees apart.
    """

    def __init__(self, device: Device, avatars: Sequence[AvatarBuffers]) -> None:
        """One avatar at least. Errors: InputError where a buffer is more than the device can bind or hold."""
        counts = [len(avatar.avatar.rig.texels.texels) for avatar in avatars]
        self.splat_count = sum(counts)
        self._load_kernels(device)
        self._create_buffers(device)
        self.avatars: tuple[AvatarFrame, ...] = tuple(
            AvatarFrame(device, avatar, self.splats, first_splat=first)
            for avatar, first in zip(avatars, accumulate(counts, initial=0), strict=False)
        )

    def _load_kernels(self, device: Device) -> None:
        self._splat_project = device.kernel("splat_project.compute", "SplatProject")
        self._scan_counts = device.kernel("splat_project.compute", "ScanCounts")
        self._splat_compact = device.kernel("splat_project.compute", "SplatCompact")
        self._count_digits = device.kernel("splat_sort.compute", "CountDigits")
        self._scan_digits = device.kernel("splat_sort.compute", "ScanDigits")
        self._scatter_digits = device.kernel("splat_sort.compute", "ScatterDigits")

    def _create_buffers(self, device: Device) -> None:
        splats, buffer = self.splat_count, device.buffer
        self.splats = buffer(64 * splats, name="splats")  # [N, 16] words (mua.kernels.dq_skinning.pack_splats)
        self.ellipses = buffer(FLOAT * 6 * EYES * splats, name="ellipses")  # [E, N, 6]
        self.colors = buffer(8 * splats, name="colors")  # [N, 4] halves
        self.flags = buffer(4 * splats, name="flags")
        self.group_counts = buffer(4 * groups(splats, PROJECTED), name="group_counts")
        self.arguments = buffer(32, name="arguments", indirect=True)
        self.keys = tuple(buffer(4 * splats, name=f"keys {i}") for i in range(2))
        self.orders = tuple(buffer(4 * splats, name=f"order {i}") for i in range(2))
        self.digit_counts = buffer(4 * DIGITS * groups(splats, SORTED), name="digit_counts")
        self.digit_totals = buffer(4 * DIGITS, name="digit_totals")
        self.sorted = SortedSplats(  # two passes of the sort end where they began
            splats, self.splats, self.ellipses, self.colors, self.orders[0], self.arguments
        )

    def sort(self, commands: Commands, cameras: Sequence[Camera]) -> None:
        """Append the dispatches from posed splats to `sorted`, the splats that one or two eyes see, back to front.

        Errors: InputError unless there are one or two cameras of one screen.
        """
        if not 1 <= len(cameras) <= EYES or any(camera.screen != cameras[0].screen for camera in cameras):
            screens = ", ".join("x".join(map(str, camera.screen)) for camera in cameras)
            raise InputError(f"cameras have the screens [{screens}]; expected one or {EYES} of one size")
        self._project(commands, cameras)
        for i, shift in enumerate(DIGIT_SHIFTS):
            self._sort_digit(commands, shift, source=i % 2)

    def box(self) -> Array:
        """[2, 3] world box of what was decoded last, metres."""
        return union(np.stack([avatar.bounds for avatar in self.avatars]))

    def _project(self, commands: Commands, cameras: Sequence[Camera]) -> None:
        low, high = self.box()
        pair = (cameras[0], cameras[-1])
        threads = (groups(self.splat_count, PROJECTED), 1, 1)
        commands.dispatch(
            self._splat_project,
            threads,
            {
                "splats": self.splats,
                "ellipses": self.ellipses,
                "colors": self.colors,
                "flags": self.flags,
                "group_counts": self.group_counts,
            },
            view=np.stack([camera.view for camera in pair]),
            projection=np.stack([camera.projection for camera in pair]),
            camera=np.append(np.mean([camera.position for camera in cameras], axis=0), 1),
            bounds_low=np.append(low, 1),
            bounds_high=np.append(high, 1),
            screen=np.array(cameras[0].screen),
            near=cameras[0].near,
            eyes=len(cameras),
            splat_count=self.splat_count,
        )
        commands.dispatch(
            self._scan_counts,
            (1, 1, 1),
            {"group_counts": self.group_counts, "arguments": self.arguments},
            splat_count=self.splat_count,
            instances=1,
        )
        commands.dispatch(
            self._splat_compact,
            threads,
            {
                "flags": self.flags,
                "group_counts": self.group_counts,
                "visible": self.orders[0],
                "keys": self.keys[0],
            },
            splat_count=self.splat_count,
        )

    def _sort_digit(self, commands: Commands, shift: int, *, source: int) -> None:
        """One pass of the sort, from buffers `source` of the two pairs to the others."""
        keys, arguments = self.keys[source], self.arguments
        counts = {"digit_counts": self.digit_counts, "arguments": arguments}
        totals = {**counts, "digit_totals": self.digit_totals}
        target = {"sorted_keys": self.keys[1 - source], "sorted_values": self.orders[1 - source]}
        commands.dispatch_indirect(self._count_digits, arguments, SORT_ARGUMENTS, {"keys": keys, **counts}, shift=shift)
        commands.dispatch(self._scan_digits, (DIGITS, 1, 1), totals)
        commands.dispatch_indirect(
            self._scatter_digits,
            arguments,
            SORT_ARGUMENTS,
            {"keys": keys, "values": self.orders[source], **totals, **target},
            shift=shift,
        )
