"""The weight of each channel's error: one over the spread of its attribute, and 0 where nothing varies."""

import numpy as np
import pytest
import torch

from mua.channels import APPEARANCE, ATTRIBUTES, GEOMETRY
from mua.student.targets import channel_weights, still_channels

LEAST = {"offset": 1e-5, "rotation": 1e-4, "scale": 1e-4, "opacity": 1e-3, "SH": 1e-4}  # metres, logarithms, logits
SPREADS = {"offset": 0.02, "rotation": 0.3, "scale": 0.5, "opacity": 4.0, "SH": 0.1}


def variances(spreads: dict[str, float]) -> torch.Tensor:
    """Variances [23] of attributes whose channels have equal spread."""
    variance = torch.zeros(23)
    for name, spread in spreads.items():
        variance[ATTRIBUTES[name]] = spread**2
    return variance


@pytest.mark.parametrize("part", [GEOMETRY, APPEARANCE])
def test_weighted_channels_spread_alike_whatever_their_unit(part: slice) -> None:
    variance = variances(SPREADS)[part]
    weights = channel_weights(variance, part)
    np.testing.assert_allclose(weights**2 * variance, np.ones(len(variance)), rtol=8 * float(np.finfo(np.float32).eps))


def test_the_channels_of_an_attribute_share_the_weight_of_their_mean_variance() -> None:
    variance = variances(SPREADS)
    variance[ATTRIBUTES["offset"]] = torch.tensor([1e-4, 4e-4, 1e-3])
    weights = channel_weights(variance[GEOMETRY], GEOMETRY)[ATTRIBUTES["offset"]]
    np.testing.assert_allclose(weights, np.full(3, 1 / np.sqrt(5e-4)), rtol=1e-6)


@pytest.mark.parametrize("size", [1.0, 0.01, 50.0])
def test_what_hardly_varies_is_still_and_not_stretched(size: float) -> None:
    """Offsets are lengths, which grow with the figure; angles and colours do not."""
    least = {name: spread * (size if name == "offset" else 1) for name, spread in LEAST.items()}
    for factor, still in ((0.9, True), (1.1, False)):
        variance = variances({name: factor * spread for name, spread in least.items()})
        for part in (GEOMETRY, APPEARANCE):
            assert still_channels(variance[part], part, size=size).tolist() == [still] * len(variance[part])
            weights = channel_weights(variance[part], part, size=size)
            expected = torch.zeros(23)
            for name, spread in least.items():
                expected[ATTRIBUTES[name]] = 1 / (spread * max(factor, 1))
            np.testing.assert_allclose(weights, expected[part], rtol=1e-5)
