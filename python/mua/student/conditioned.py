"""MLPs in coordinates that suit gradient descent, and their fold into the plain MLP that the file holds.

Adam's steps are as long for every weight, while blendshape coefficients differ a thousandfold in what they are worth.
So MLPs are trained to coordinates of the texture; the map from these is linear, hence part of the last layer once
training ends.
"""

import torch
from torch import Tensor, nn

from mua.student.model import build_mlp, linear_layers


class Conditioned(nn.Module):
    """An MLP, then a linear map from its K coordinates to M outputs."""

    def __init__(
        self,
        mlp: nn.Sequential,
        expand: Tensor,  # [K, M]
    ) -> None:
        super().__init__()
        self.mlp = mlp
        self.expand = nn.Linear(len(expand), expand.shape[1]).to(expand.device)
        with torch.no_grad():
            self.expand.weight.copy_(expand.T)
            self.expand.bias.zero_()

    def forward(self, inputs: Tensor) -> Tensor:
        """Outputs [F, M] for inputs of the MLP."""
        outputs: Tensor = self.expand(self.mlp(inputs))
        return outputs

    @torch.no_grad()
    def folded(self) -> nn.Sequential:
        """An equal function as a plain MLP."""
        first, *_, last = linear_layers(self.mlp)
        plain = build_mlp(first.in_features, first.out_features, self.expand.out_features).to(last.weight.device)
        *hidden, end = linear_layers(plain)
        for layer, own in zip(hidden, linear_layers(self.mlp), strict=False):
            layer.load_state_dict(own.state_dict())
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
