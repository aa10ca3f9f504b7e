"""A body of two limbs for tests: what each shows depends on itself alone, and in training they move together."""

import torch

from mua.student.local import Locality


def two_limbs(frames: int, *, seed: int, together: bool) -> tuple[torch.Tensor, torch.Tensor]:
    """Descriptors of two limbs [F, 2 D] and what the texels of each show [F, 2], which depends on its own limb alone.

    In training, one limb always does nearly what the other does.
    """
    generator = torch.Generator().manual_seed(seed)
    one = torch.randn(frames, 3, generator=generator)
    other = (
        one + 0.2 * torch.randn(frames, 3, generator=generator)
        if together
        else torch.randn(frames, 3, generator=generator)
    )
    shown = [torch.sin(limb[:, 0]) + 0.5 * limb[:, 1] * limb[:, 2] for limb in (one, other)]
    return torch.cat([one, other], dim=1), torch.stack(shown, dim=1)


def limb_steps() -> torch.Tensor:
    """The second limb is one joint from the first."""
    return torch.tensor([[0, 0, 0, 1, 1, 1], [1, 1, 1, 0, 0, 0]])


def limbs_apart(fade: float) -> Locality:
    own = torch.tensor([1.0, 1, 1, fade, fade, fade])
    shares = torch.zeros(2, 2, 2)
    shares[0, 0, 0] = shares[1, 1, 1] = 1
    return Locality(limb_steps(), torch.stack([own, own.flip(0)]), shares)
