"""How far outside of training an avatar in a file is, by the reference."""

from pathlib import Path

import numpy as np

from mua.asset import read
from mua.pose.clip import Clip
from mua.pose.components import read_components
from mua.pose.descriptor import describe_window
from mua.pose.resample import sample


def outside_of_training(path: Path, frame: int, *, clip: Clip | None = None) -> float:
    """Of a frame of a clip, the file's first unless another is given, at the rate of the avatar's encoding."""
    avatar = read(path)
    encoding = avatar.encoding
    window = sample(clip or avatar.clips[0], np.array(encoding.frames(frame)), rate=encoding.rate)
    descriptor = describe_window(avatar.rig.skeleton, encoding, window.rotations, window.translations)
    return float(read_components(avatar.components, descriptor)[1])
