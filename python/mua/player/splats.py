"""All avatars' splats together: the dispatches from posed texels to the splats that one or two eyes see, back to front.

Kept a plain list in the order of the kernels, so that unity-package/Runtime/SplatFrame.cs reads line for line like it.
"""

from collections.abc import Sequence
from typing import Generic, Protocol, TypeVar

import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera, sees
from mua.avatar.level_choice import splat_corners
from mua.errors import InputError
from mua.gpu import Buffer, Commands, Device
from mua.kernels.splat_project import SPLAT_WORDS
from mua.player.buffers import RigPlaces
from mua.player.channels import FLOAT, groups
from mua.player.draw import SortedSplats
from mua.rig.bounds import union

EYES = 2  # eyes at most
MOST_SPLATS = (1 << 24) - 1  # the most that an element of the sort can index beside the value for none
PROJECTED = 256  # texels of a group of SplatProject
SORTED = 2048  # keys of a group of the sort
DIGITS = 256  # values of 8 bits
SCANNED = 16  # digits of a group of ScanDigits
ARGUMENTS = 5  # words: the arguments of the draw, and how many splats some eye sees


class Posed(Protocol):
    """An avatar whose vertices are posed and whose channels are decoded: AvatarFrame or TexturedRig."""

    @property
    def rig(self) -> RigPlaces: ...

    @property
    def splat_count(self) -> int: ...  # at most the count of its first frame

    @property
    def mesh(self) -> Buffer: ...  # [V, 3] canonical vertices

    @property
    def texel_channels(self) -> Buffer: ...  # [6, N, 4] halves

    vertex_dq: Buffer  # [V, 8]
    bounds: Array  # [2, 3] world box, metres


P = TypeVar("P", bound=Posed)


class SplatFrame(Generic[P]):
    """One sort for all avatars in view, so that those that stand among each other blend rightly.

    Those outside every eye's view are neither projected nor sorted; their splats' places lie behind the others'.
    """

    def __init__(self, device: Device, avatars: Sequence[P]) -> None:
        """For at least one avatar. Errors: InputError where there are too many splats for the device or the sort."""
        self.avatars = tuple(avatars)
        self._seen = (True,) * len(self.avatars)  # set by the last sort
        self._corners = 6  # vertices of a splat, by the last sort
        if self.splat_count > MOST_SPLATS:
            raise InputError(f"{self.splat_count} splats of all avatars; expected at most {MOST_SPLATS}")
        self._load_kernels(device)
        self._create_buffers(device)

    @property
    def splat_count(self) -> int:
        """Decoded splats of all avatars, each avatar's number rounded up to an even one."""
        return int(self._counts.sum())

    @property
    def first_splats(self) -> tuple[int, ...]:
        """Index of each avatar's first splat, avatars in view before the others; all are even."""
        order = np.argsort(np.logical_not(self._seen), kind="stable")
        starts = np.cumsum(self._counts[order]) - self._counts[order]
        return tuple(starts[np.argsort(order)].tolist())

    @property
    def sorted_count(self) -> int:
        """Splats of the avatars that the last sort found in view."""
        return int(self._counts[list(self._seen)].sum())

    @property
    def sorted(self) -> SortedSplats:
        """What the last sort left to draw."""
        return SortedSplats(self.splats, self.order, self.arguments, self._corners)

    @property
    def _counts(self) -> Array:
        return np.array([avatar.splat_count + avatar.splat_count % 2 for avatar in self.avatars], dtype=int)

    def _load_kernels(self, device: Device) -> None:
        self._splat_project = device.kernel("splat_project.compute", "SplatProject")
        self._count_digits = device.kernel("splat_sort.compute", "CountDigits")
        self._scan_digits = device.kernel("splat_sort.compute", "ScanDigits")
        self._scatter_digits = device.kernel("splat_sort.compute", "ScatterDigits")

    def _create_buffers(self, device: Device) -> None:
        splats, buffer = self.splat_count, device.buffer
        self.splats = buffer(4 * SPLAT_WORDS * splats, name="splats")  # mua.kernels.splat_project.pack_splats
        self.keys = buffer(FLOAT * splats // 2, name="keys")  # mua.kernels.splat_project.pack_keys
        self.digit_counts = buffer(FLOAT * DIGITS * groups(splats, SORTED), name="digit_counts")
        self.digit_totals = buffer(FLOAT * DIGITS, name="digit_totals")
        self.arguments = buffer(FLOAT * ARGUMENTS, name="arguments", indirect=True)
        self.half_sorted = buffer(FLOAT * splats, name="half_sorted")
        self.order = buffer(FLOAT * splats, name="order")

    def sort(self, commands: Commands, cameras: Sequence[Camera]) -> None:
        """Append the dispatches from posed texels to `sorted`, the splats that one or two eyes see, back to front.

        Errors: InputError unless there are one or two cameras of one screen.
        """
        if not 1 <= len(cameras) <= EYES or any(camera.screen != cameras[0].screen for camera in cameras):
            screens = ", ".join("x".join(map(str, camera.screen)) for camera in cameras)
            raise InputError(f"cameras have the screens [{screens}]; expected one or {EYES} of one size")
        self._seen = tuple(any(sees(c, _reach(avatar.bounds)) for c in cameras) for avatar in self.avatars)
        for avatar, first_splat, seen in zip(self.avatars, self.first_splats, self._seen, strict=True):
            if seen:
                self._project(commands, avatar, first_splat, cameras)
        boxes = (avatar.bounds for avatar, seen in zip(self.avatars, self._seen, strict=True) if seen)
        self._corners = splat_corners(boxes, self.sorted_count, cameras)
        self._sort_digit(commands, self.keys, self.half_sorted, second_pass=0)
        self._sort_digit(commands, self.half_sorted, self.order, second_pass=1)

    def box(self) -> Array:
        """[2, 3] world box of what was posed last, metres: of the avatars in view, or of all where none is."""
        boxes = np.stack([avatar.bounds for avatar in self.avatars])
        return union(boxes[np.array(self._seen)] if any(self._seen) else boxes)

    def _project(self, commands: Commands, avatar: P, first_splat: int, cameras: Sequence[Camera]) -> None:
        low, high = self.box()
        pair = (cameras[0], cameras[-1])
        commands.dispatch(
            self._splat_project,
            (groups(avatar.splat_count, PROJECTED), 1, 1),
            {
                "mesh": avatar.mesh,
                "faces": avatar.rig.faces,
                "texels": avatar.rig.texels,
                "texel_channels": avatar.texel_channels,
                "vertex_dq": avatar.vertex_dq,
                "splats": self.splats,
                "keys": self.keys,
            },
            view=np.stack([camera.view for camera in pair]),
            projection=np.stack([camera.projection for camera in pair]),
            bounds_low=np.append(low, 1),  # at the size that it was baked with
            bounds_high=np.append(high, 1),
            screen=np.array(cameras[0].screen),
            near=cameras[0].near,
            eyes=len(cameras),
            texel_count=avatar.splat_count,
            first_splat=first_splat,
        )

    def _sort_digit(self, commands: Commands, keys: Buffer, sorted: Buffer, *, second_pass: int) -> None:
        """One pass of the sort, from the splats' keys to elements, or from those to the order."""
        blocks = (max(groups(self.sorted_count, SORTED), 1), 1, 1)  # the first one writes the draw's arguments
        counts = {"digit_counts": self.digit_counts, "arguments": self.arguments}
        totals = {**counts, "digit_totals": self.digit_totals}
        constants = {"second_pass": second_pass, "key_count": self.sorted_count}
        commands.dispatch(self._count_digits, blocks, {"keys": keys, **counts}, **constants)
        commands.dispatch(self._scan_digits, (DIGITS // SCANNED, 1, 1), totals, **constants)
        moved = {"keys": keys, **totals, "sorted": sorted}
        commands.dispatch(self._scatter_digits, blocks, moved, **constants, instances=1, corners=self._corners)


def _reach(
    bounds: Array,  # [2, 3]
) -> Array:
    """The box [2, 3] that splats may reach: half a diagonal beyond, as far as SplatProject keys their depth."""
    spare = np.linalg.norm(bounds[1] - bounds[0]) / 2
    return np.stack([bounds[0] - spare, bounds[1] + spare])
