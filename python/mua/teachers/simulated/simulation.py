"""Position-based dynamics of a surface that follows its skinned shape: soft tissue and hanging cloth.

Every vertex hangs on a damped spring at its skinned position (stiff on skin, weak on cloth), its edges resist
stretching, and bending is resisted by evening out neighbours' displacements from the skinned shape; gravity acts as
far as the skinned shape has turned from rest, and loose cloth is pushed out of the capsules around the bones
(Mueller et al. 2007, https://doi.org/10.1016/j.jvcir.2007.01.005; Jacobi iterations: every run gives the same bytes).

The springs are damped near their critical value, so that the state is a function of the last tenths of a second.
The evening-out keeps what is shorter than about 4 cm small: a student has no dynamics there.
"""

# mypy: disable-error-code="index, operator, attr-defined, no-untyped-def, var-annotated"
# (the bodies of the kernels are Warp's language, not Python)

import numpy as np
import warp as wp

from mua.arrays import Array, unique_rows
from mua.rig.bones import Bones, capsule_distance, figure_scale
from mua.teachers.simulated.rings import LANES, in_blocks, relax
from mua.training.warp_start import start

DEVICE = "cpu"  # a frame takes milliseconds: less than its way to a GPU and back
SUBSTEP = 1 / 120  # seconds, at most
ITERATIONS = 4  # of the constraints in a substep
SETTLE_SECONDS = 1.0  # at the first pose of a clip

CLOTH_FREQUENCY = 1.4  # hertz, of the spring where looseness is 1
FIRMING = 1.5  # power of looseness by which the spring stiffens
DAMPING = 0.8  # of critical
DRAG = 0.6  # 1 / s, of the air on cloth
GRAVITY = 9.81
STRETCH = 0.5  # share of an edge's error that an iteration takes out where looseness is 1
SLACK = 0.3  # share of that for an edge shorter than at rest: cloth folds before it shortens
LEAST_SAG = 2e-5  # metres on a person: what hangs less is rigid, as heads and hands are, where most vertices lie
BENDING = 0.5  # m^2 / s^2: (length over which displacements even out x frequency of the spring)^2
SHORTEST_EDGE = 1e-4  # metres on a person
LOOSE = 0.5  # cloth above this looseness collides with the bones
GAP = 0.01  # metres between cloth and bones' skin

start()


@wp.kernel(enable_backward=False)
def even_out(
    starts: wp.array[int],
    neighbours: wp.array[int],
    evening: wp.array[float],
    target: wp.array[wp.vec3],
    even: wp.array[wp.vec3],
):
    """Where evening out would move each vertex of the skinned shape: bending is measured from there."""
    i = wp.tid()
    place = target[i]
    move = wp.vec3(0.0, 0.0, 0.0)
    for k in range(starts[i], starts[i + 1]):
        move += (target[neighbours[k]] - place) * evening[k]
    even[i] = move


@wp.kernel(enable_backward=False)
def predict(
    now: wp.array[wp.vec3],
    before: wp.array[wp.vec3],
    target_from: wp.array[wp.vec3],
    target_to: wp.array[wp.vec3],
    even_from: wp.array[wp.vec3],
    even_to: wp.array[wp.vec3],
    force: wp.array[wp.vec3],
    looseness: wp.array[float],
    frequency: wp.array[float],
    drag: wp.array[float],
    damping: float,
    moment: float,
    frame_time: float,
    step: float,
    even: wp.array[wp.vec3],
    ahead: wp.array[wp.vec3],
):
    """Move each vertex by inertia, spring and gravity for one substep; implicit in the spring, so always stable.

    Rigid vertices are where skinning puts them, and stay so in both arrays that the constraints take turns with: the
    places before are read here for the last time.
    """
    i = wp.tid()
    aim = wp.lerp(target_from[i], target_to[i], moment)
    if looseness[i] == 0.0:
        ahead[i] = aim
        before[i] = aim
        return
    even[i] = wp.lerp(even_from[i], even_to[i], moment)
    velocity = (now[i] - before[i]) / step
    pace = (target_to[i] - target_from[i]) / frame_time
    w = frequency[i]
    friction = 2.0 * damping * w
    push = w * w * (aim - now[i]) + friction * pace + force[i]
    velocity = (velocity + step * push) / (1.0 + step * (friction + drag[i]) + step * step * w * w)
    ahead[i] = now[i] + step * velocity


@wp.kernel(enable_backward=False)
def collide(
    vertices: wp.array[int],
    clearance: wp.array2d[float],
    ends: wp.array2d[wp.vec3],
    places: wp.array[wp.vec3],
):
    """Push loose vertices out of each bone's capsule, but never farther than they are from it at rest."""
    k = wp.tid()
    i = vertices[k]
    place = places[i]
    for c in range(ends.shape[0]):
        start = ends[c, 0]
        axis = ends[c, 1] - start
        along = wp.dot(place - start, axis) / wp.max(wp.dot(axis, axis), 1.0e-12)
        away = place - start - axis * wp.clamp(along, 0.0, 1.0)
        distance = wp.max(wp.length(away), 1.0e-9)
        if distance < clearance[k, c]:
            place += away * (clearance[k, c] / distance - 1.0)
    places[i] = place


class Simulation:
    """The moving surface: where it is and where it was a substep ago."""

    def __init__(
        self,
        vertices: Array,  # [V, 3] bind pose, metres
        faces: Array,  # [F, 3]
        *,
        looseness: Array,  # [V] 0..1
        bones: Bones,
        scale: float | None = None,  # size of the figure over that of a person; None: these are all of its vertices
    ) -> None:
        self._scale = figure_scale(vertices) if scale is None else scale
        looseness = np.where(hangs(looseness), looseness, 0)
        starts, neighbours = one_rings(faces, len(vertices))
        own = np.repeat(np.arange(len(vertices)), np.diff(starts))
        lengths = np.maximum(np.linalg.norm(vertices[neighbours] - vertices[own], axis=1), SHORTEST_EDGE * self._scale)
        per_ring = 4 / np.diff(starts)[own]  # of edges, in the discrete Laplacian
        evening = per_ring * BENDING * SUBSTEP**2 / ITERATIONS / (lengths / self._scale) ** 2
        evening /= 1 + np.bincount(own, evening, len(vertices))[own]
        shares = _stretch_shares(own, neighbours, looseness)
        evening = _within_limit(evening, own, room=1 - np.bincount(own, shares, len(vertices)))
        self._rings = _ints(starts), _ints(neighbours), _floats(evening)
        self._constraints = _constraints(starts, neighbours, lengths, shares, evening, looseness)
        self._frequency = _floats(spring_frequency(looseness))
        self._drag, self._looseness = _floats(DRAG * looseness), _floats(looseness)
        loose = np.flatnonzero(looseness > LOOSE)
        at_rest = capsule_distance(vertices[loose][:, None], bones.ends[:, 0], bones.ends[:, 1])
        self._loose = _ints(loose)
        self._clearance = wp.array(np.minimum(bones.radii + GAP * self._scale, at_rest), dtype=float, device=DEVICE)
        self._places = [_vectors(vertices) for _ in range(3)]  # now, a substep ago, to be written next
        self._even = _vectors(np.zeros_like(vertices))
        self._last = _vectors(vertices), _vectors(vertices)  # the skinned shape and where it would even out
        self._relaxing: dict[tuple[int, int], wp.Launch] = {}

    def settle(
        self,
        target: Array,  # [V, 3] skinned positions
        turn: Array,  # [V, 4] skinned rotations
        ends: Array,  # [C, 2, 3] bones
    ) -> None:
        """Start at rest in a pose: hang still, as if the pose had been held for long."""
        self._last = self._aim(target)
        for places in self._places:
            wp.copy(places, self._last[0])
        self.advance(target, turn, ends, seconds=SETTLE_SECONDS)
        wp.copy(self._places[1], self._places[0])

    def advance(
        self,
        target: Array,  # [V, 3] skinned positions at the end of the step
        turn: Array,  # [V, 4] skinned rotations
        ends: Array,  # [C, 2, 3] bones
        *,
        seconds: float,
    ) -> Array:
        """Move on by `seconds`, while the skinned shape goes steadily to `target`; returns positions [V, 3] float64."""
        steps = max(1, round(seconds / SUBSTEP))
        aim, capsules = self._aim(target), wp.array(ends, dtype=wp.vec3, ndim=2, device=DEVICE)
        force = _vectors(self._scale * gravity_beyond_rest(turn))
        for step in range(steps):
            self._predict(aim, force, moment=(step + 1) / steps, seconds=seconds, substep=seconds / steps)
            self._constrain(capsules)
        self._last = aim
        return np.asarray(self._places[0].numpy(), dtype=np.float64)

    def _aim(self, target: Array) -> tuple[wp.array, wp.array]:
        """A skinned shape, and where evening out would move its vertices."""
        places = _vectors(target)
        even = wp.empty_like(places)
        wp.launch(even_out, dim=len(places), inputs=[*self._rings, places], outputs=[even], device=DEVICE)
        return places, even

    def _predict(
        self, aim: tuple[wp.array, wp.array], force: wp.array, *, moment: float, seconds: float, substep: float
    ) -> None:
        """Fill the third of the places with where inertia, spring and gravity lead."""
        now, before, ahead = self._places
        shapes = [now, before, self._last[0], aim[0], self._last[1], aim[1], force]
        wp.launch(
            predict,
            dim=len(now),
            inputs=[*shapes, self._looseness, self._frequency, self._drag, DAMPING, moment, seconds, substep],
            outputs=[self._even, ahead],
            device=DEVICE,
        )

    def _constrain(self, capsules: wp.array) -> None:
        """Bring the predicted places nearer to the constraints and make them the present ones."""
        now, spare, ahead = self._places
        for _ in range(ITERATIONS):
            self._relax(ahead, spare)
            ahead, spare = spare, ahead
        if len(self._loose):
            inputs = [self._loose, self._clearance, capsules, ahead]
            wp.launch(collide, dim=len(self._loose), inputs=inputs, device=DEVICE)
        self._places = [ahead, now, spare]

    def _relax(self, now: wp.array, ahead: wp.array) -> None:
        """One iteration; its launch is kept, as preparing one takes half as long as its work."""
        blocks = len(self._constraints[0]) // LANES
        if not blocks:
            return
        key = now.ptr, ahead.ptr
        if key not in self._relaxing:
            inputs = [*self._constraints, SLACK, *(array.view(float).flatten() for array in (self._even, now, ahead))]
            self._relaxing[key] = wp.launch(relax, dim=blocks, inputs=inputs, device=DEVICE, record_cmd=True)
        self._relaxing[key].launch()


def _constraints(
    starts: Array,  # [V + 1]
    neighbours: Array,  # [E]
    lengths: Array,  # [E] at rest
    shares: Array,  # [E] of an edge's error that its first vertex takes out in an iteration
    evening: Array,  # [E] share of a neighbour's displacement that a vertex takes over in an iteration
    looseness: Array,  # [V]
) -> list[wp.array]:
    """First argument of `rings.relax`: the edges about all vertices that are not rigid, in blocks."""
    blocks = in_blocks(starts, np.flatnonzero(looseness > 0))
    by_edge = ((lengths, 1.0), (shares, 0.0), (evening, 0.0))
    return [
        _ints(blocks.vertices.ravel()),
        _ints(blocks.starts),
        _ints(np.where(blocks.edges >= 0, neighbours[blocks.edges], blocks.owners).ravel()),
        *(_floats(blocks.by_edge(values, none=none).ravel()) for values, none in by_edge),
    ]


def _stretch_shares(own: Array, neighbours: Array, looseness: Array) -> Array:
    """Share [E] of an edge's error that its first vertex takes out in an iteration."""
    counts = np.bincount(own, minlength=len(looseness))
    return STRETCH * looseness[own] ** 3 / counts[own] / np.maximum(looseness[own] + looseness[neighbours], 1e-30)


def _within_limit(evening: Array, own: Array, *, room: Array) -> Array:
    """Evening [E] that adds up to no more than `room` [V] about any vertex.

    With stretch, a vertex then moves no farther than to its neighbours, and an iteration enlarges no difference. Beyond
    that, two vertices a tenth of a millimetre apart threw each other out of the scene.
    """
    total = np.bincount(own, evening, len(room))
    return np.asarray(evening * np.minimum(1, room / np.maximum(total, np.finfo(float).tiny))[own])


def spring_frequency(looseness: Array) -> Array:
    """Radians per second [V] of the springs that hold vertices at their skinned positions."""
    return np.asarray(2 * np.pi * CLOTH_FREQUENCY / np.maximum(looseness, 1e-3) ** FIRMING)


def hangs(
    looseness: Array,  # [V] 0..1
) -> Array:
    """Which vertices [V] are not rigid."""
    return np.asarray(GRAVITY / spring_frequency(looseness) ** 2 >= LEAST_SAG)


def gravity_beyond_rest(
    turn: Array,  # [V, 4] skinned rotations
) -> Array:
    """Accelerations [V, 3], m / s^2: gravity less that which the rest shape bears, turned with the surface."""
    w, x, y, z = turn.T
    return 2 * GRAVITY * np.stack([x * y - w * z, -(x * x + z * z), y * z + w * x], axis=1)


def one_rings(faces: Array, count: int) -> tuple[Array, Array]:
    """Starts [V + 1] and neighbours [E]: vertex i touches neighbours[starts[i]:starts[i + 1]], ascending."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    own, other = unique_rows(np.concatenate([edges, edges[:, ::-1]]))[0].T
    return np.searchsorted(own, np.arange(count + 1)), other


def _vectors(values: Array) -> wp.array:
    return wp.array(values, dtype=wp.vec3, device=DEVICE)


def _floats(values: Array) -> wp.array:
    return wp.array(values, dtype=float, device=DEVICE)


def _ints(values: Array) -> wp.array:
    return wp.array(values, dtype=int, device=DEVICE)
