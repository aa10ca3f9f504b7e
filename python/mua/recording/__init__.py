"""A teacher's frames on disk: streamed, sharded, append-only; a killed writer leaves a valid recording.

    recording.json        version, hash of the rig, rate, wavelet, sizes
    rig.npz               the rig
    reference.npz         the first whole frame: texture [N, 23] float32 and its subbands, float32
    shards/00000/         up to `shard_frames` recorded frames and every pose up to the last of them
        index.json        which frames of which clips; CRC-32 of each file
        rotations.npy     [P, J, 4] float64 local joint rotations of all frames, recorded or not
        translations.npy  [P, J, 3] float64 local joint translations, metres
        meshes.npy        [S, V, 3] float32 canonical vertices, metres
        ll.npy            [S, 23, n, n] float16, less the reference's; n = size / 16
        d3.npy            [S, 3, 23, n, n] float16, likewise
        d2.npy            [S, 3, 23, 2n, 2n] float16, likewise
        whole_00007.npy   [N, 23] float16 texture less the reference's, of the shard's recorded frame 7, if kept whole
        sum.npy           [N, 23] float64 sum of (texture - reference) over all training frames so far; last shard only

A shard is written under a hidden name, synced and renamed: it is there whole or not at all. Names beginning with a dot
are leftovers of a killed writer; readers pass over them and the next writer removes them. Means of D1 and D0 need no
subbands per frame: the transform is linear, so they are those of the mean texture.
"""

from mua.recording.plausible import LikelyMistake
from mua.recording.reader import RecordedClip, Recording, WholeFrame
from mua.recording.record import PlannedClip, record
from mua.recording.writer import TeacherWriter

__all__ = [
    "LikelyMistake",
    "PlannedClip",
    "RecordedClip",
    "Recording",
    "TeacherWriter",
    "WholeFrame",
    "record",
]
