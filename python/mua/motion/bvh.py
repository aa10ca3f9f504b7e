"""Read BVH motion: a hierarchy of offsets and Euler channels, then one row of numbers per frame.

The format states neither units nor the up axis. Units are taken as the common one (metres, centimetres, millimetres,
decimetres, inches) that give the skeleton a person's span; the up axis is Z where heads are above feet along Z, X where
they are along X in the frames and in the rest pose, and Y points down, as cameras see it, where hardly a frame has the
head above the feet.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.errors import InputError
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.joint_names import roles
from mua.pose.skeleton import Skeleton

UNITS = (1.0, 0.01, 0.001, 0.1, 0.0254)  # metres per unit, the likeliest first
PERSON_SPAN = (1.7, 3.2)  # metres along the bones from fingertip to toe, child to giant
TYPICAL_SPAN = 2.35
LONGEST = 1e6  # units: a person of 1 km in millimetres
HELD = 1e-4  # of the span: a joint whose place in its parent changes by less keeps the mean
SLOWEST = 5.0  # seconds between frames; more are frames per second or milliseconds in their place
WHOLE_RATE = 1e-3  # relative: 0.033333 s means 30 frames per second
MOST = 0.5  # share of frames with heads above feet along Z or X, rather than Y, from which on it is up
ON_HEAD = 0.9  # of the frames that have heads below feet: more than any handstand is of its clip
COMMENTS = ("#", "//", ";")  # the format has none, editors and scripts write them nevertheless
UTF_16 = (b"\xff\xfe", b"\xfe\xff")
TO_Y_UP = {
    "X is up": np.array([np.sqrt(0.5), 0, 0, np.sqrt(0.5)]),
    "Z is up": np.array([np.sqrt(0.5), -np.sqrt(0.5), 0, 0]),
    "Y is down": np.array([0.0, 1, 0, 0]),
}


@dataclass(frozen=True, eq=False)
class _Node:
    name: str
    parent: int
    offset: Array  # [3] file units
    channels: tuple[str, ...]  # lower case, in file order; empty for an end site


def read_bvh(path: Path, *, scale: float | None = None) -> SourceMotion:
    """Read the motion of a BVH file; end sites become joints named `<parent>_end`.

    scale: metres per unit of the file; estimated where it is not given.
    Errors: InputError for a broken hierarchy, an unknown channel, a wrong number of values, no frames, NaN or infinity.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    text = content.decode("utf-16" if content[:2] in UTF_16 else "utf-8", errors="replace").lstrip("\ufeff")
    lines = [line for line in text.splitlines() if not line.lstrip().startswith(COMMENTS)]
    motion = next((i for i, line in enumerate(lines) if line.strip().lower() == "motion"), None)
    if motion is None:
        raise InputError(f"{path}: expected a line MOTION after the hierarchy, found none")
    nodes = _parse_hierarchy(path, lines[:motion])
    rate, count, values = _parse_motion(path, lines[motion + 1 :], sum(len(node.channels) for node in nodes))
    read = _assemble(path, nodes, rate, values, scale)
    if len(values) == count:
        return read
    note = f"{path.name}: holds {len(values)} frames, though it says {count}; all are read."
    return replace(read, notes=(note, *read.notes))


def _parse_hierarchy(path: Path, lines: list[str]) -> list[_Node]:
    """Turn the HIERARCHY section into nodes, parents before children."""
    words = [line.replace("{", "\n{\n").replace("}", "\n}\n").splitlines() for line in lines]
    statements = [part.split() for line in words for part in line if part.strip()]
    if not statements or statements[0][0].lower() != "hierarchy":
        raise InputError(
            f"{path}: expected HIERARCHY in the first line, found {lines[0][:40]!r}" if lines else f"{path}: is empty"
        )
    nodes: list[_Node] = []
    open_nodes: list[int] = []
    for statement in statements[1:]:
        keyword, values = statement[0].lower(), statement[1:]
        if keyword in ("root", "joint", "end"):
            parent = open_nodes[-1] if open_nodes else -1
            if (keyword == "root") == bool(nodes) or (parent < 0) == bool(nodes):
                raise InputError(
                    f"{path}: {' '.join(statement)}: expected one ROOT and every other joint inside of it; "
                    "save every person to a file of their own"
                )
            name = f"{nodes[parent].name}_end" if keyword == "end" else " ".join(values)
            nodes.append(_Node(name, parent, np.zeros(3), ()))
        elif keyword == "{" and nodes and len(nodes) - 1 not in open_nodes:
            open_nodes.append(len(nodes) - 1)
        elif keyword == "}" and open_nodes:
            open_nodes.pop()
        elif keyword in ("offset", "channels") and open_nodes:
            read = _offset if keyword == "offset" else _channels
            nodes[open_nodes[-1]] = read(path, nodes[open_nodes[-1]], values)
        else:
            raise InputError(
                f"{path}: HIERARCHY: expected a joint, OFFSET, CHANNELS or a brace, found {' '.join(statement)!r}"
            )
    if open_nodes or not nodes:
        raise InputError(
            f"{path}: HIERARCHY: {len(open_nodes)} braces are not closed before MOTION, expected a whole joint tree"
        )
    return nodes


def _offset(path: Path, node: _Node, values: list[str]) -> _Node:
    offset = _numbers(path, f"OFFSET of {node.name}", values)
    if len(offset) != 3:
        raise InputError(f"{path}: OFFSET of {node.name}: expected 3 numbers, found {len(offset)}")
    return _Node(node.name, node.parent, offset, node.channels)


def _channels(path: Path, node: _Node, values: list[str]) -> _Node:
    known = {f"{axis}{kind}" for axis in "xyz" for kind in ("position", "rotation")}
    channels = tuple(value.lower() for value in values[1:])
    if not values or values[0] != str(len(channels)):
        raise InputError(
            f"{path}: CHANNELS of {node.name}: expected a count and as many names, found {' '.join(values)!r}"
        )
    for channel in channels:
        if channel not in known:
            raise InputError(f"{path}: CHANNELS of {node.name}: expected Xposition .. Zrotation, found {channel!r}")
    return _Node(node.name, node.parent, node.offset, channels)


def _parse_motion(path: Path, lines: list[str], width: int) -> tuple[float, int, Array]:
    """Return frames per second, how many frames there should be, and values [F, width] of the MOTION section.

    Where every line is a whole frame, they may be more or fewer than stated: files are cut by hand.
    """
    rows = [line for line in lines if line.strip()]
    count = _header(path, rows, 0, "Frames:")
    frame_time = _header(path, rows, 1, "Frame Time:")
    if count < 1 or count != int(count):
        raise InputError(f"{path}: Frames: expected at least 1 frame, found {count:g}")
    if not 0 < frame_time <= SLOWEST:
        raise InputError(
            f"{path}: Frame Time: expected seconds above 0 and up to {SLOWEST:g}, found {frame_time:g}; write "
            "0.0333333 there for 30 frames per second"
        )
    values = _numbers(path, "MOTION", " ".join(rows[2:]).split())
    whole_lines = len(rows) > 2 and all(len(row.split()) == width for row in rows[2:])
    if not whole_lines and (len(values) != count * width):
        raise InputError(
            f"{path}: MOTION: expected {int(count)} frames of {width} values, found {len(values)} values "
            f"({len(values) / max(width, 1):g} frames)"
        )
    rate = 1 / frame_time
    whole = max(round(rate), 1)
    rate = float(whole) if abs(rate - whole) < WHOLE_RATE * whole else rate
    return rate, int(count), values.reshape(-1, width) if width else values.reshape(int(count), 0)


def _header(path: Path, rows: list[str], index: int, label: str) -> float:
    line = " ".join(rows[index].replace(":", " : ", 1).split()).replace(" :", ":", 1) if index < len(rows) else ""
    if not line.lower().startswith(label.lower()):
        raise InputError(f"{path}: MOTION: expected {label!r} and a number, found {line[:40]!r}")
    values = _numbers(path, label.rstrip(":"), line[len(label) :].split())
    if len(values) != 1:
        raise InputError(f"{path}: {label} expected one number, found {line[len(label) :]!r}")
    return float(values[0])


def _numbers(path: Path, field: str, words: list[str]) -> Array:
    """Numbers of a field; commas are decimal points, as some languages write them, unless there are points too."""
    text = " ".join(words)
    if "," in text:
        words = text.replace(",", " " if "." in text or ", " in text else ".").split()
    try:
        values = np.array(words, dtype=float)
    except ValueError as error:
        raise InputError(f"{path}: {field}: expected numbers, {error}") from error
    if not np.isfinite(values).all():
        raise InputError(
            f"{path}: {field}: expected finite numbers, found {words[int(np.argmin(np.isfinite(values)))]}"
        )
    return values


def _assemble(path: Path, nodes: list[_Node], rate: float, values: Array, scale: float | None) -> SourceMotion:
    """Build skeleton and clip of nodes and values [F, channels] in file units."""
    span = _span(nodes)
    if span > LONGEST or (len(nodes) > 1 and span == 0):
        raise InputError(f"{path}: HIERARCHY: the longest way along OFFSETs is {span:g}, expected the lengths of bones")
    scale = _likely_unit(span) if scale is None else scale
    offsets = np.array([node.offset for node in nodes])
    skeleton = Skeleton(
        names=tuple(node.name for node in nodes),
        parents=np.array([node.parent for node in nodes], dtype=np.int32),
        bind_rotations=np.tile([1.0, 0, 0, 0], (len(nodes), 1)),
        bind_translations=offsets,
        root=0,
    )
    rotations, positions = _decode_channels(nodes, values)
    root = _moving_root(skeleton, positions)
    leads = [root, *skeleton.ancestors(root)]
    moves = np.ptp(positions, axis=0).max(axis=-1) > HELD * span
    moves[leads] = True
    rest = positions.mean(axis=0)
    rest[leads] = offsets[leads]
    skeleton = replace(skeleton, bind_translations=rest * scale, root=root)
    clip = Clip(path.stem, rate, rotations, np.where(moves[:, None], positions, rest) * scale)
    notes = []
    if axis := _other_up(skeleton, clip):
        skeleton, clip = _turn(skeleton, clip, TO_Y_UP[axis])
        notes.append(f"{path.name}: {axis}; turned to Y up.")
    return SourceMotion(skeleton, clip, tuple(notes))


def _decode_channels(nodes: list[_Node], values: Array) -> tuple[Array, Array]:
    """Return local rotations [F, J, 4] and local positions [F, J, 3] in file units.

    Rotations apply in the order of the channels, each about the axes that the ones before it have turned. Positions
    stand for the offset, as most writers mean them; below the root they add to it where those of most joints come
    nearer to zero than to the offset.
    """
    rotations = np.tile([1.0, 0, 0, 0], (len(values), len(nodes), 1))
    positions = np.tile(np.array([node.offset for node in nodes]), (len(values), 1, 1))
    column = 0
    for j, node in enumerate(nodes):
        for channel in node.channels:
            axis = "xyz".index(channel[0])
            if channel.endswith("position"):
                positions[:, j, axis] = values[:, column]
            else:
                turn = rotation.from_axis_angle(np.eye(3)[axis], np.radians(values[:, column]))
                rotations[:, j] = rotation.multiply(rotations[:, j], turn)
            column += 1
    moving = [
        j
        for j, node in enumerate(nodes)
        if node.parent >= 0 and node.offset.any() and any(channel.endswith("position") for channel in node.channels)
    ]
    offsets = np.array([nodes[j].offset for j in moving]).reshape(-1, 3)
    to_zero, to_offset = (np.linalg.norm(positions[:, moving] - place, axis=-1).min(axis=0) for place in (0.0, offsets))
    if 2 * np.count_nonzero(to_zero < to_offset) > len(moving):
        positions[:, moving] += offsets
    return rotations, positions


def _moving_root(skeleton: Skeleton, positions: Array) -> int:
    """The joint that carries the motion's translation: the hips, else the first below the ROOT that moves."""
    hips = roles(skeleton)["hips"][0]
    moves = np.ptp(positions, axis=0).any(axis=-1)
    root = 0
    while not moves[root] and np.count_nonzero(skeleton.parents == root) == 1:
        root += 1  # an only child follows its parent in the file
    return root if hips == 0 and moves[root] else hips


def _span(nodes: list[_Node]) -> float:
    """The longest way along bones between two ends: a measure of size that no pose changes."""
    deepest = [0.0] * len(nodes)
    span = 0.0
    for j in range(len(nodes) - 1, 0, -1):
        reach = deepest[j] + float(np.linalg.norm(nodes[j].offset))
        span = max(span, deepest[nodes[j].parent] + reach)
        deepest[nodes[j].parent] = max(deepest[nodes[j].parent], reach)
    return span


def _likely_unit(span: float) -> float:
    """Metres per unit that make `span` a person's, or come nearest to it."""
    if span <= 0:
        return 1.0
    for unit in UNITS:
        if PERSON_SPAN[0] <= span * unit <= PERSON_SPAN[1]:
            return unit
    return min(UNITS, key=lambda unit: abs(np.log(span * unit / TYPICAL_SPAN)))


def _other_up(skeleton: Skeleton, clip: Clip) -> str:
    """The up axis as a key of TO_Y_UP, by how heads (or hips) are above feet; empty where it is Y."""
    named = roles(skeleton)
    feet = [*named.get("left foot", ()), *named.get("right foot", ())]
    if not feet:
        return ""
    above = named.get("head", named["hips"])[0]
    x, y, z = np.moveaxis(_way_up(skeleton, clip.rotations, clip.translations, feet, above), -1, 0)
    at_rest = _way_up(skeleton, skeleton.bind_rotations, skeleton.bind_translations, feet, above)
    # a sleeper lies along X in all frames, but not in the rest pose too
    if at_rest[0] > abs(at_rest[1:]).max() and np.mean(x > np.maximum(abs(y), abs(z))) > MOST:
        return "X is up"
    if np.mean(z > abs(y)) > MOST:
        return "Z is up"
    return "Y is down" if np.mean(y < 0) > ON_HEAD and -y.mean() > abs(z.mean()) else ""


def _way_up(skeleton: Skeleton, rotations: Array, translations: Array, feet: list[int], above: int) -> Array:
    """From the middle of the feet to the joint above them [..., 3], in poses [..., J, 4 and 3]."""
    _, positions = skeleton.world(rotations, translations)
    return positions[..., above, :] - positions[..., feet, :].mean(axis=-2)


def _turn(skeleton: Skeleton, clip: Clip, turn: Array) -> tuple[Skeleton, Clip]:
    """Turn the world, and so the rest pose and every frame, by the quaternion `turn` [4]."""
    top = skeleton.parents < 0
    rotations = clip.rotations.copy()
    rotations[:, top] = rotation.multiply(turn, rotations[:, top])
    bind_rotations, bind_translations = skeleton.bind_rotations.copy(), skeleton.bind_translations.copy()
    bind_rotations[top] = rotation.multiply(turn, bind_rotations[top])
    bind_translations[top] = rotation.rotate(turn, bind_translations[top])
    translations = clip.translations.copy()
    translations[:, top] = rotation.rotate(turn, translations[:, top])
    skeleton = replace(skeleton, bind_rotations=bind_rotations, bind_translations=bind_translations)
    return skeleton, replace(clip, rotations=rotations, translations=translations)
