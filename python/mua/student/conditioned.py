"""MLPs in the coordinates that gradient descent likes, and their fold into the plain MLP that the file holds.

Adam's steps are as long for every weight, while directions of the descriptor, and blendshape coefficients, differ a
thousandfold in what they are worth. So MLPs are trained between whitened descriptors and coordinates of the texture;
both maps are linear, hence parts of the first and last layer once training ends.
"""

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from mua.student.model import build_mlp, linear_layers

INPUT_FLOOR = 1.0  # variance added to each direction of the normalised descriptors; measured on held-out CMU walks


@dataclass(frozen=True, eq=False)
class Whitening:
    """An affine map of descriptors whose directions vary alike: x -> (x - mean) @ turn."""

    mean: Tensor  # [k D]
    turn: Tensor  # [k D, k D]

    def __call__(self, inputs: Tensor) -> Tensor:
        return (inputs - self.mean) @ self.turn


def whitening(inputs: Tensor) -> Whitening:
    """The whitening of normalised descriptors [F, k D].

    A window's poses are nearly alike; velocities are its weak directions, and a network that sees the descriptor as it
    is learns them last. The floor keeps directions that hold only noise from being raised to the others' level.
    """
    mean = inputs.mean(0)
    variance, directions = torch.linalg.eigh(torch.cov(inputs.double().T, correction=0).reshape(inputs.shape[1], -1))
    return Whitening(mean, (directions / (variance.clamp(min=0) + INPUT_FLOOR).sqrt()).to(inputs))


class Conditioned(nn.Module):
    """mlp((x - mean) @ turn), then a linear map from its K coordinates to M outputs; mean and turn stay as they are."""

    mean: Tensor
    turn: Tensor

    def __init__(
        self,
        white: Whitening,
        mlp: nn.Sequential,
        expand: Tensor,  # [K, M]
    ) -> None:
        super().__init__()
        self.register_buffer("mean", white.mean)
        self.register_buffer("turn", white.turn)
        self.mlp = mlp
        self.expand = nn.Linear(len(expand), expand.shape[1]).to(expand.device)
        with torch.no_grad():
            self.expand.weight.copy_(expand.T)
            self.expand.bias.zero_()

    def forward(self, inputs: Tensor) -> Tensor:
        """[F, M] of normalised descriptors [F, k D]."""
        outputs: Tensor = self.expand(self.mlp((inputs - self.mean) @ self.turn))
        return outputs

    @torch.no_grad()
    def folded(self) -> nn.Sequential:
        """The same function as a plain MLP."""
        first, *_, last = linear_layers(self.mlp)
        plain = build_mlp(first.in_features, first.out_features, self.expand.out_features).to(self.turn.device)
        *hidden, end = linear_layers(plain)
        for layer, own in zip(hidden, linear_layers(self.mlp), strict=False):
            layer.load_state_dict(own.state_dict())
        start = hidden[0]
        start.weight.copy_(first.weight @ self.turn.T)
        start.bias.copy_(first.bias - start.weight @ self.mean)
        end.weight.copy_(self.expand.weight @ last.weight)
        end.bias.copy_(self.expand.weight @ last.bias + self.expand.bias)
        return plain


def fold(module: nn.Module) -> None:
    """Replace every conditioned MLP within `module` by its plain one, in place."""
    for name, child in list(module.named_children()):
        if isinstance(child, Conditioned):
            setattr(module, name, child.folded())
        else:
            fold(child)
