"""Keyframes of glTF animations; glTF 2.0, appendix C."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.gltf.document import Document

INTERPOLATIONS = ("STEP", "LINEAR", "CUBICSPLINE")


@dataclass(frozen=True, eq=False)
class KeyTrack:
    """The keys of one channel."""

    times: Array  # [K] seconds, none before the one ahead of it
    values: Array  # [K, n], for CUBICSPLINE [3 K, n]: tangent in, value, tangent out
    kind: str  # one of INTERPOLATIONS

    def at(self, times: Array, *, spherical: bool = False) -> Array:
        """Values [F, n] at times [F]; those outside the keys hold the nearest."""
        keys = self.values
        if self.kind == "CUBICSPLINE":
            return _cubic(self.times, keys, times)
        if len(self.times) == 1:
            return np.repeat(keys[:1], len(times), axis=0)
        before = np.clip(np.searchsorted(self.times, times, side="right") - 1, 0, len(self.times) - 1)
        if self.kind == "STEP":
            return keys[before]
        before = np.minimum(before, len(self.times) - 2)
        fraction = _fraction(self.times, before, times)
        if spherical:
            keys = rotation.normalize(keys)
            return rotation.slerp(keys[before], keys[before + 1], fraction)
        return keys[before] + fraction[:, None] * (keys[before + 1] - keys[before])


def read_keys(
    document: Document,
    animation: Any,
    where: str,
    c: int,  # channel
    *,
    types: tuple[str, ...],
    width: int = 1,  # elements for each key
) -> KeyTrack:
    """The keys of a channel, of `width` elements each; an InputError names the field where they are broken."""
    channel, samplers = animation.channels[c], animation.samplers or []
    if not isinstance(channel.sampler, int) or not 0 <= channel.sampler < len(samplers):
        raise document.error(f"{where}.channels[{c}].sampler is {channel.sampler}, of {len(samplers)} samplers")
    sampler, at = samplers[channel.sampler], f"{where}.samplers[{channel.sampler}]"
    times = document.accessor(sampler.input, field=f"{at}.input", types=("SCALAR",))[:, 0].astype(float)
    values = document.accessor(sampler.output, field=f"{at}.output", types=types).astype(float)
    kind = sampler.interpolation or "LINEAR"
    if kind not in INTERPOLATIONS:
        raise document.error(f"{at}.interpolation is {kind}, expected {', '.join(INTERPOLATIONS)}")
    keys = len(times) * (3 if kind == "CUBICSPLINE" else 1)
    if len(values) != keys * width:
        raise document.error(f"{at}.output holds {len(values)} elements, expected {keys * width} for its {kind} keys")
    if (np.diff(times) < 0).any():
        raise document.error(f"{at}.input holds times that decrease")
    return KeyTrack(times, values.reshape(keys, -1), kind)


def _fraction(times: Array, before: Array, at: Array) -> Array:
    """How far [F] times are from the keys [F] before them to the next; 1 between two keys of one time, a jump."""
    span = times[before + 1] - times[before]
    return np.clip(np.divide(at - times[before], span, out=np.ones(len(at)), where=span > 0), 0, 1)


def _cubic(times: Array, keys: Array, at: Array) -> Array:
    into, value, out = keys[0::3], keys[1::3], keys[2::3]
    if len(times) == 1:
        return np.repeat(value[:1], len(at), axis=0)
    k = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
    span = (times[k + 1] - times[k])[:, None]
    t = _fraction(times, k, at)[:, None]
    return np.asarray(
        (2 * t**3 - 3 * t**2 + 1) * value[k]
        + span * (t**3 - 2 * t**2 + t) * out[k]
        + (3 * t**2 - 2 * t**3) * value[k + 1]
        + span * (t**3 - t**2) * into[k + 1]
    )
