"""A teacher's recording in a bake's work directory, taken up where an earlier run of the same bake left it."""

import hashlib
from collections.abc import Callable, Iterable

from mua.baking.listener import Listener
from mua.baking.settings import BakeSettings
from mua.filters import WAVELET
from mua.pose.clip import Clip
from mua.pose.encoding import RATE
from mua.recording import PlannedClip, Recording
from mua.recording.workers import Worker, record_by_workers
from mua.teacher import Teacher
from mua.version import __version__


def recorded(
    make_teacher: Callable[[], Teacher],
    key: str,
    settings: BakeSettings,
    planned: list[PlannedClip],
    listener: Listener,
    waiting: list[Worker] | None = None,  # of waiting_workers
) -> Recording:
    """The recording of `planned`; `key` of `recording_key` distinguishes it from those of other settings."""
    directory = settings.work / f"recording-{key}"
    listener.stage("recording")
    total = sum(len(clip.wanted) for clip in planned)
    record_by_workers(
        make_teacher,
        planned,
        directory,
        jobs=settings.jobs,
        rate=RATE,
        waiting=waiting,
        progress=lambda done, workers: listener.step(done, total, detail=f"{workers} at work"),
        note=listener.note,
    )
    return Recording(directory)


def recording_key(teacher: Iterable[bytes], planned: list[PlannedClip]) -> str:
    """Changes with the wavelet, the teacher (the bytes that it depends on), the clips and what is kept of them."""
    digest = hashlib.sha256(f"{__version__} {WAVELET}".encode())
    for part in teacher:
        digest.update(part)
    for clip in planned:
        digest.update(f"{clip.clip.name} {clip.held_out} {sorted(clip.wanted)} {sorted(clip.whole or ())}".encode())
        for motion in (clip.clip, clip.run_up):
            digest.update(b"none" if motion is None else motion_bytes(motion))
    return digest.hexdigest()[:12]


def motion_bytes(clip: Clip) -> bytes:
    """What a clip moves, frame by frame."""
    own = clip.rotations.tobytes() + clip.translations.tobytes()
    if clip.stretches is None:
        return own
    return own + clip.stretches.joints.tobytes() + clip.stretches.matrices.tobytes()
