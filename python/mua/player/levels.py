"""The level of detail at which a player shows an avatar: the chosen one, or the one that suits its distance."""

from collections.abc import Sequence

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.camera import Camera
from mua.avatar.coarser import coarsest, texel_length
from mua.avatar.level_choice import Seen, choose_level, texel_pixels

AUTO, FULL = "auto", "full"  # chosen by the distance; the finest
Wanted = str | int  # or texels along a side


class Levels:
    """The level choice of one avatar, from image to image."""

    def __init__(self, avatar: Avatar, wanted: Wanted) -> None:
        size = avatar.rig.texels.size
        self.sizes = tuple(size >> level for level in range(coarsest(avatar) + 1))  # texels along a side, by level
        self.wanted = wanted
        self._skeleton, self._bounds = avatar.rig.skeleton, avatar.bounds
        self._length = texel_length(avatar)
        self._shown = 0

    @property
    def note(self) -> str:
        """A sentence where the wanted level does not exist; else empty."""
        sizes = ", ".join(map(str, self.sizes))
        if self.wanted == AUTO and len(self.sizes) == 1:
            return f"the avatar has no coarser level of detail; it is shown at its {sizes} texels from everywhere."
        if isinstance(self.wanted, int) and self.wanted not in self.sizes:
            return f"the avatar has no level of {self.wanted} texels but {sizes}; it is shown at full size."
        return ""

    def choose(
        self,
        rotations: Array,  # [J, 4] local joint rotations
        translations: Array,  # [J, 3] local joint translations, metres
        cameras: Sequence[Camera],
    ) -> int:
        """The level for the next image, 0 being the finest."""
        if self.wanted == AUTO:
            root = self._skeleton.world(rotations, translations)[1][self._skeleton.root]
            distance, texel = texel_pixels(self._length, self._bounds + root, cameras)
            self._shown = choose_level(Seen(distance, texel, self.sizes, self._shown))
        else:
            self._shown = self.sizes.index(self.wanted) if self.wanted in self.sizes else 0
        return self._shown
