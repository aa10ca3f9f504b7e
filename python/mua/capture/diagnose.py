"""Problems of a capture, by how the template fits the masks: a sentence for each."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from mua.arrays import Array
from mua.capture.apart import GAIN, POOR, cameras_apart, cameras_below, missing_lens
from mua.capture.capture import Capture
from mua.capture.colours import different_colours
from mua.capture.conventions import better_convention
from mua.capture.fit import Posed, Seen, by_camera, mean_overlap
from mua.capture.image_faults import image_faults, sentences
from mua.capture.mask_edges import holes, wide_or_narrow
from mua.capture.silhouette import POINTS, overlap, posed_template, rough_overlap, silhouette
from mua.capture.tracks import PointTracks, read_tracks
from mua.errors import InputError

GOOD = 0.8  # mean overlap that a skinned template reaches also with loose clothes
SHIFT_GAIN = 0.03  # overlap by which other poses must fit all views of a clip better
FAR = 100.0  # metres from the template to cameras, beyond which lengths have another unit
FARTHEST_SHIFT = 30  # frames by which images and poses may be apart
BESIDE = 0.1  # of the template's height, beyond which tracked points are not on it
TRACKED = 200  # points that are looked at
TRIED = 6  # views that shifts are tried on


def unlikely(capture: Capture, posed: Posed, views: Sequence[Seen]) -> list[str]:
    """All problems that were found; where one cause explains the others, it alone."""
    problems = [*_empty(views), *_full(views)]
    filled = [view for view in views if view.mask.any() and not view.mask.all()]
    inverted = _inverted(filled)
    problems += _inverted_masks(inverted, filled)
    filled = [view for view in filled if view.camera.name not in inverted]
    faults = image_faults(posed, filled)
    if mean_overlap(filled) < POOR and filled and (found := better_convention(posed, filled)) is not None:
        convention, fitting, now = found
        means = {name: mean_overlap(of) for name, of in by_camera(filled).items()}
        if fitting > np.mean([faults[name].then if name in faults else mean for name, mean in means.items()]):
            return [*problems, f"Outlines and masks overlap by {now:.0%}; they would by {fitting:.0%} if {convention}."]
    problems += sentences(faults, len(by_camera(filled)))
    filled = [view for view in filled if view.camera.name not in faults]
    problems += _far(capture, posed)
    unseen = [name for name in _unseen(views) if name not in faults]
    problems += [f"Camera {name} sees nobody: the posed template is outside its image." for name in unseen]
    filled = [view for view in filled if view.camera.name not in unseen]
    if shifted := list(_shifted(capture, posed, filled)):
        return problems + shifted
    if filled and max(mean_overlap(of) for of in by_camera(filled).values()) < POOR:
        return [
            *problems,
            f"Outlines and masks overlap by {mean_overlap(filled):.0%}, and no other axes, units or frames that were "
            "tried fit better: look at the image.",
        ]
    return [*problems, *cameras_apart(posed, filled), *missing_lens(posed, filled)]


def remarks(capture: Capture, views: Sequence[Seen], *, fits: bool) -> list[str]:
    """What is worth a look: empty masks, their edges and holes, colours and, where all else `fits`, low overlaps."""
    filled = [view for view in views if view.mask.any()]
    edges, mean = list(wide_or_narrow(capture, filled)), mean_overlap(filled)
    found = [*_sometimes_empty(views), *edges, *holes(filled), *different_colours(filled)]
    if not fits or not filled:
        return found
    found += cameras_below(filled)
    if mean >= GOOD or edges:
        return found
    return [
        *found,
        f"Outlines and masks overlap by {mean:.0%} on average; {GOOD:.0%} or more is usual, also with loose clothes. "
        "Compare template, poses and masks in the image that -o writes.",
    ]


def misplaced_tracks(capture: Capture, posed: Posed) -> Iterator[str]:
    """Tracks that cannot be read, and those that are not of the person, a sentence for each."""
    for clip in capture.clips if capture.tracks or capture.tracks_2d else ():
        try:
            read = read_tracks(capture, clip.name)
        except InputError as error:
            yield f"Clip {clip.name}: {error}."
            continue
        for tracks in read if clip.name in posed.vertices else ():
            away, height = _tracked_away(tracks, posed.vertices[clip.name]), np.ptp(posed.surfaces.vertices[:, 1])
            if away > BESIDE * height:
                yield (
                    f"Clip {clip.name}: {tracks.file}: half of the points are more than {away:.2f} m from the posed "
                    "template; expected points of the person, counted from the clip's first frame."
                )


def _tracked_away(tracks: PointTracks, vertices: Array) -> float:
    """The median distance of tracked points from the nearest vertices [F, V, 3] in the frame with the most, metres."""
    frame = int(np.count_nonzero(tracks.weights, axis=1).argmax())
    seen = np.flatnonzero(tracks.weights[frame])[:TRACKED]
    near = vertices[frame, :: max(1, vertices.shape[1] // POINTS)]
    apart = near - tracks.points[frame, seen, None]
    if tracks.directions is not None:
        ray = tracks.directions[frame, seen, None]
        apart = apart - np.sum(apart * ray, axis=2, keepdims=True) * ray
    return float(np.median(np.linalg.norm(apart, axis=2).min(axis=1)))


def _empty(views: Sequence[Seen]) -> Iterator[str]:
    for name, of in by_camera(views).items():
        if not any(view.mask.any() for view in of):
            yield f"Camera {name}: all masks that were looked at ({len(of)}) are empty."


def _full(views: Sequence[Seen]) -> Iterator[str]:
    for name, of in by_camera(views).items():
        if all(view.mask.all() for view in of):
            yield (
                f"Camera {name}: all masks that were looked at ({len(of)}) cover the whole image; expected white for "
                "the person and black elsewhere."
            )


def _sometimes_empty(views: Sequence[Seen]) -> Iterator[str]:
    for name, of in by_camera(views).items():
        empty = [view for view in of if not view.mask.any()]
        if 0 < len(empty) < len(of):
            yield (
                f"Camera {name}: {len(empty)} of {len(of)} masks that were looked at are empty and count nowhere, "
                f"first clip {empty[0].clip}, frame {empty[0].frame}."
            )


def _inverted(views: Sequence[Seen]) -> dict[str, float]:
    """Cameras whose masks fit the template far better the other way round, and how well then."""
    inverse = {n: float(np.mean([overlap(v.covered, ~v.mask) for v in of])) for n, of in by_camera(views).items()}
    return {n: inverse[n] for n, of in by_camera(views).items() if inverse[n] > max(POOR, mean_overlap(of) + GAIN)}


def _inverted_masks(inverted: Mapping[str, float], views: Sequence[Seen]) -> Iterator[str]:
    every = len(inverted) > 1 and len(inverted) == len(by_camera(views))
    named = (
        {"All cameras": float(np.mean([*inverted.values()]))}
        if every
        else {f"Camera {n}": inverted[n] for n in inverted}
    )
    for name, fitting in named.items():
        yield f"{name}: masks are inverted, by {fitting:.0%} they fit what is black; expected white for the person."


def _unseen(views: Sequence[Seen]) -> list[str]:
    """Cameras in none of whose views the template is."""
    return [name for name, of in by_camera(views).items() if not any(view.covered.any() for view in of)]


def _far(capture: Capture, posed: Posed) -> Iterator[str]:
    person = np.concatenate([vertices.reshape(-1, 3) for vertices in posed.vertices.values()]).mean(axis=0)
    distances = [float(np.linalg.norm(camera.position - person)) for camera in capture.cameras]
    if distances and np.median(distances) > FAR:
        yield f"The cameras are {np.median(distances):,.0f} metres away from the template: expected lengths in metres."


def _shifted(capture: Capture, posed: Posed, views: Sequence[Seen]) -> Iterator[str]:
    """Clips whose images fit other poses of their motion, all by the same number of frames."""
    for clip in capture.clips:
        own = [view for view in views if view.clip == clip.name]
        if not own:
            continue
        some = [own[i] for i in np.unique(np.linspace(0, len(own) - 1, TRIED).astype(int))]
        now = mean_overlap(some)
        shift, fitting = _best_shift(capture, posed, some)
        if fitting > now + SHIFT_GAIN:
            yield (
                f"Clip {clip.name}: outlines and masks overlap by {now:.0%}; they would by {fitting:.0%} with "
                f"first = {clip.first + shift} in place of {clip.first}."
            )


def _best_shift(capture: Capture, posed: Posed, views: Sequence[Seen]) -> tuple[int, float]:
    """The shift in frames at which later poses fit some views of one clip best, and their overlap then."""
    clip, motion = capture.clip(views[0].clip), capture.whole_motion(views[0].clip)
    last = len(motion) - clip.first - clip.frames
    shifts = range(max(-FARTHEST_SHIFT, -clip.first), min(FARTHEST_SHIFT, last) + 1)
    wanted = np.array([[clip.first + view.frame + shift for view in views] for shift in shifts])
    poses, place = np.unique(wanted, return_inverse=True)
    vertices = posed_template(posed.surfaces, motion.cut(poses))[place.reshape(wanted.shape)]
    rough = [np.mean([rough_overlap(v, s.camera, s.mask) for v, s in zip(of, views, strict=True)]) for of in vertices]
    nearest = np.argsort(rough)[::-1][:TRIED]
    faces = posed.surfaces.faces
    exact = [
        np.mean([overlap(silhouette(v, faces, s.camera), s.mask) for v, s in zip(vertices[i], views, strict=True)])
        for i in nearest
    ]
    best = int(np.argmax(exact))
    return shifts[nearest[best]], float(exact[best])
