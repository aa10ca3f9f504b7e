"""Poses that fit the images: in every frame small turns of all joints and a small move of the root, both bounded."""

import math

import torch
from torch import Tensor, nn

from mua.pose.skeleton import Skeleton
from mua.splatting.posing import dual_transform, multiply, rotate

MOVE = 0.01  # metres on a person along each axis that the root may be moved for each degree that joints may be turned
VANISHES = 1e-4  # length of a twist below which there is no heading: a person upside down faces nowhere


class PoseRefinement(nn.Module):
    """Small corrections of the poses of training frames; unseen motion keeps its given poses."""

    rotations: Tensor  # [F, k, J, 4]
    translations: Tensor  # [F, k, J, 3]
    unbind: Tensor  # [J, 8]
    rest: Tensor  # [3] of the root in the bind pose, metres

    def __init__(
        self,
        skeleton: Skeleton,
        rotations: Tensor,  # [F, k, J, 4] local, of each frame's window, newest first
        translations: Tensor,  # [F, k, J, 3] local, metres
        *,
        most: float,  # degrees about each axis
        size: float = 1.0,  # of the figure over that of a person
    ) -> None:
        super().__init__()
        self.most, self.farthest, self.root = math.radians(most), MOVE * most * size, skeleton.root
        self.parents = [int(parent) for parent in skeleton.parents]
        self.register_buffer("rotations", rotations.float(), persistent=False)
        self.register_buffer("translations", translations.float(), persistent=False)
        self.register_buffer("unbind", torch.as_tensor(skeleton.bind_inverse).float(), persistent=False)
        _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
        self.register_buffer("rest", torch.as_tensor(places[skeleton.root]).float(), persistent=False)
        self.moves = nn.Parameter(torch.zeros(len(rotations), 3))  # of the root, in shares of `farthest`
        self.turns = nn.Parameter(torch.zeros(len(rotations), len(self.parents), 3))  # half angles in shares of `most`

    def forward(self, frame: int) -> Tensor:
        """Dual quaternions [k, J, 8] of a frame's window, bind pose to world; all of it gets the same correction."""
        half = torch.tanh(self.turns[frame]) * (self.most / 2)
        turn = nn.functional.normalize(torch.cat([torch.ones_like(half[..., :1]), half], dim=-1), dim=-1)
        moved = torch.zeros_like(self.translations[frame])
        moved[:, self.root] = torch.tanh(self.moves[frame]) * self.farthest
        rotations = self.rotations[frame]
        return self._skinning(multiply(rotations, turn.expand_as(rotations)), self.translations[frame] + moved)

    def place(
        self,
        joints: Tensor,  # [J, 8] bind pose to world
    ) -> Tensor:
        """The root's position [3], metres."""
        return dual_transform(joints[self.root], self.rest)

    def back(
        self,
        joints: Tensor,  # [J, 8] bind pose to world
    ) -> Tensor:
        """The rotation [4] that removes the heading, as `mua.pose.descriptor.heading_of` has it."""
        twist = joints[self.root, :4] * joints.new_tensor([1.0, 0, -1, 0])
        upright = joints.new_tensor([1.0, 0, 0, 0])
        return nn.functional.normalize(torch.where(twist.norm() < VANISHES, upright, twist), dim=0)

    def size(self) -> Tensor:
        """The squared corrections, as shares of what is allowed, summed over a frame and averaged over frames."""
        return self.turns.square().sum(dim=(1, 2)).mean() + self.moves.square().sum(dim=1).mean()

    def _skinning(self, rotations: Tensor, translations: Tensor) -> Tensor:
        """Dual quaternions as `mua.pose.skeleton.Skeleton.skinning` gives them, with gradients."""
        turned: list[Tensor] = []
        placed: list[Tensor] = []
        for joint, parent in enumerate(self.parents):
            turn, place = rotations[:, joint], translations[:, joint]
            if parent >= 0:
                place = placed[parent] + rotate(turned[parent], place)
                turn = multiply(turned[parent], turn)
            turned.append(turn)
            placed.append(place)
        turns, places = torch.stack(turned, dim=1), torch.stack(placed, dim=1)
        moved = multiply(torch.cat([torch.zeros_like(places[..., :1]), places], dim=-1), turns) / 2
        real, dual = self.unbind[:, :4].expand_as(turns), self.unbind[:, 4:].expand_as(turns)
        return torch.cat([multiply(turns, real), multiply(turns, dual) + multiply(moved, real)], dim=-1)
