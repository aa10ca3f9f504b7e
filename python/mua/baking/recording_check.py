"""Checks a recording before training: its figures as sentences, likely mistakes, and three of its frames."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arguments import amount
from mua.arrays import Array
from mua.channels import ATTRIBUTES, SH_C0
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton
from mua.recording import Recording, WholeFrame
from mua.recording.plausible import Finding, Plausible, rig_findings

PICTURED = 3  # frames
MESHES = 64  # that are looked at, beside those of whole frames
SHORTEST = 12  # frames of a clip whose order can be checked
MOVES = np.radians(3)  # the mean turn of joints between any two frames of a clip that moves
IN_ORDER = 0.6  # times that turn: the most that neighbouring frames differ by
UPRIGHT, MOSTLY = 0.5, 0.9  # cosine of the lean, and the share of frames that lean further, of a figure that lies
STILL = 1e-4  # standard deviation of a channel's samples that is invisible


@dataclass(frozen=True)
class RecordingCheck:
    """The result of checking a recording."""

    figures: dict[str, str]
    findings: tuple[Finding, ...]  # one for each cause
    pictured: tuple[WholeFrame, ...]  # the first, one in the middle and the last of those kept whole


def check(recording: Recording) -> RecordingCheck:
    """Check the rig, every pose, and a sample of meshes and textures."""
    frames = list(_pictured(recording))
    findings = [
        *(Finding(f"rig: {found.sentence}", found.certain) for found in rig_findings(recording.rig)),
        *_frames(recording),
        *_motion(recording),
        *_variety(recording),
    ]
    return RecordingCheck(_figures(recording, frames), _one_for_each_cause(findings), tuple(frames))


def _pictured(recording: Recording) -> Iterator[WholeFrame]:
    count = recording.whole_count
    chosen = {(count - 1) * part // max(PICTURED - 1, 1) for part in range(PICTURED)}
    return (frame for number, frame in enumerate(recording.whole_frames()) if number in chosen)


def _frames(recording: Recording) -> Iterator[Finding]:
    """What looks like a mistake in a pose, a mesh or a texture."""
    plausible = Plausible(recording.rig)
    for clip in recording.clips:
        for index in range(len(clip)):
            yield from _placed(clip.name, index, plausible.pose(clip.pose(index)))
    for frame in recording.whole_frames():
        pose = frame.clip.pose(frame.index)
        yield from _placed(frame.clip.name, frame.index, plausible.frame(pose, frame.mesh, frame.texture))
    training = [(clip, int(index)) for clip in recording.clips if not clip.held_out for index in clip.recorded]
    rows = np.unique(np.linspace(0, len(training) - 1, min(len(training), MESHES)).astype(int))
    for row, mesh in zip(rows, recording.meshes(rows), strict=True):
        clip, index = training[row]
        yield from _placed(clip.name, index, plausible.mesh(clip.pose(index), mesh))


def _placed(clip: str, frame: int, findings: Iterator[Finding]) -> Iterator[Finding]:
    for found in findings:
        yield Finding(f"clip {clip!r}, frame {frame}: {found.sentence}", found.certain)


def _one_for_each_cause(findings: list[Finding]) -> tuple[Finding, ...]:
    causes: dict[str, Finding] = {}
    for found in findings:
        causes.setdefault(found.sentence.rpartition(": ")[2], found)
    return tuple(causes.values())


def _motion(recording: Recording) -> Iterator[Finding]:
    for clip in recording.clips:
        if len(clip) >= SHORTEST and _out_of_order(clip):
            problem = f"clip {clip.name!r}: neighbouring frames differ nearly as much as any two frames of it"
            yield Finding(f"{problem}: are they in order, at {clip.rate:g} frames per second?", certain=False)
    lean = np.concatenate([_lean(recording.rig.skeleton, clip) for clip in recording.clips] or [np.zeros(0)])
    if len(lean) and np.mean(lean < UPRIGHT) > MOSTLY:
        problem = f"the figure lies or hangs in {100 * np.mean(lean < UPRIGHT):.0f} % of all frames"
        yield Finding(f"{problem}: does the motion have another up axis than the rig? Y is expected", certain=False)


def _out_of_order(clip: Clip) -> bool:
    other = np.random.default_rng(0).permutation(len(clip))
    apart = _turn(clip.rotations, clip.rotations[other])[other != np.arange(len(clip))].mean()
    return bool(apart > MOVES and _turn(clip.rotations[1:], clip.rotations[:-1]).mean() > IN_ORDER * apart)


def _turn(a: Array, b: Array) -> Array:
    """The mean angle of all joints [F] between poses [F, J, 4]."""
    return np.asarray(2 * np.arccos(np.clip(np.abs(np.sum(a * b, axis=-1)), 0, 1)).mean(axis=1))


def _lean(skeleton: Skeleton, clip: Clip) -> Array:
    """How upright the root joint is in each frame [F]: 1 as in the bind pose, -1 head down."""
    bind, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    world, _ = skeleton.world(clip.rotations, clip.translations)
    turned = rotation.multiply(world[:, skeleton.root], rotation.conjugate(bind[skeleton.root]))
    return rotation.rotate(turned, np.array([0, 1.0, 0]))[:, 1]


def _variety(recording: Recording) -> Iterator[Finding]:
    """What cannot be distilled, or cannot be measured."""
    if not recording.count():
        yield Finding("no training frame has a mesh and a texture, so nothing can be distilled", certain=True)
        return
    if not recording.count(held_out=True):
        yield Finding("no clip is held out, so errors on unseen motion will not be measured", certain=False)
    if not recording.whole_count:
        yield Finding("no frame is kept whole, so there will be neither errors nor a contact sheet", certain=False)
    rows = np.unique(np.linspace(0, recording.count() - 1, min(recording.count(), MESHES)).astype(int))
    texture = float(recording.subbands(slice(0, 23), rows).ll.std(0, correction=0).max())
    mesh = float(recording.meshes(rows).std(axis=0).max())
    if len(rows) > 1 and max(texture, mesh) < STILL:
        yield Finding("neither mesh nor texture changes: is the same frame recorded every time?", certain=False)


def _figures(recording: Recording, frames: list[WholeFrame]) -> dict[str, str]:
    rig, rate = recording.rig, recording.rate
    box = np.ptp(rig.mesh.vertices, axis=0)
    poses = sum(len(clip) for clip in recording.clips)
    held, training = recording.count(held_out=True), recording.count()
    figures = {
        "figure": f"{box[1]:.2f} m high, {box[0]:.2f} m wide, {box[2]:.2f} m deep",
        "rig": f"{amount(len(rig.skeleton.names), 'joint')}, the root is {rig.skeleton.names[rig.skeleton.root]}; "
        f"a template of {len(rig.mesh.vertices):,} vertices; "
        f"{len(rig.texels.texels):,} texels of {rig.texels.size} x {rig.texels.size}",
        "frames": f"{poses:,} at {rate:g} per second ({poses / rate:.1f} s); {training:,} recorded to train on, "
        f"{held:,} held out, {recording.whole_count:,} of them whole",
    }
    if recording.clips:
        root = np.concatenate([clip.translations[:, rig.skeleton.root] for clip in recording.clips])
        reach = np.ptp(root, axis=0)
        figures["root"] = f"moves within {reach[0]:.2f} m sideways, {reach[1]:.2f} m up and {reach[2]:.2f} m along Z"
    return {**figures, **(_channels(recording, frames) if frames else {})}


def _channels(recording: Recording, frames: list[WholeFrame]) -> dict[str, str]:
    """What the channels hold once they are activated, over the pictured frames."""
    texture = np.concatenate([frame.texture for frame in frames]).astype(np.float64)
    away = np.concatenate([np.linalg.norm(f.mesh - recording.rig.mesh.vertices, axis=1) for f in frames])
    offset = np.linalg.norm(texture[:, ATTRIBUTES["offset"]], axis=1)
    size = np.exp(np.clip(texture[:, ATTRIBUTES["scale"]].max(axis=1), -50, 50))
    opacity = 0.5 + 0.5 * np.tanh(0.5 * texture[:, ATTRIBUTES["opacity"]])
    colour = 0.5 + SH_C0 * texture[:, ATTRIBUTES["SH"]][:, :3]
    return {
        "mesh": f"{_range(away, 1000)} mm from the template",
        "offsets": f"{_range(offset, 1000)} mm",
        "splats": f"{_range(size, 1000)} mm long (standard deviation)",
        "opacity": _range(opacity),
        "colours": "; ".join(f"{name} {_range(colour[:, i])}" for i, name in enumerate(("red", "green", "blue"))),
    }


def _range(values: Array, times: float = 1) -> str:
    low, middle, high = times * np.percentile(values, [5, 50, 95])
    return f"{middle:.2f} ({low:.2f} to {high:.2f})"
