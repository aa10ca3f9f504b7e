"""What a person says a character's expressions are: a file of names, and the scene under these names."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from mua.characters.gaze import GAZE
from mua.characters.messages import listed
from mua.errors import InputError
from mua.files.write import write_bytes
from mua.pose.expression_names import rows_of
from mua.pose.expression_vocabulary import known_expression
from mua.scene import Scene


def read_expression_names(path: Path) -> dict[str, str]:
    """Read `{"expression of the character": "name"}` as JSON; an empty name leaves an expression its own.

    Errors: InputError where it cannot be read or parsed, or holds anything but strings.
    """
    try:
        names = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as names of expressions: {error}") from error
    if not isinstance(names, dict):
        raise InputError(f"{path}: expected a table of expressions and their names, found {type(names).__name__}")
    for expression, name in names.items():
        if not isinstance(name, str):
            raise InputError(f"{path}: {expression}: expected a name, found {name!r}")
    return {expression: name for expression, name in names.items() if name}


def write_expression_names(path: Path, expressions: Sequence[str]) -> None:
    """Write a file to start from: the name by which trackers move each expression, nothing where they do not."""
    names = dict.fromkeys(expressions, "") | {expressions[row]: name for name, row in rows_of(expressions).items()}
    write_bytes(path, (json.dumps(names, indent=2, ensure_ascii=False) + "\n").encode())


def with_expression_names(scene: Scene, names: Mapping[str, str], path: Path) -> Scene:
    """The scene with expressions under other names; those of one name move together, as one.

    An expression that alone means its name already keeps its own.
    Errors: InputError for an expression that the file at `path` does not have.
    """
    if not names:
        return scene
    held = dict.fromkeys(target.name for part in scene.parts for target in part.targets)
    held |= dict.fromkeys(GAZE if scene.face_rules.eyes else ())  # has its own names
    for expression in names:
        if expression not in held:
            raise InputError(
                f"{path}: --expression-names: it has no expression {expression!r}, only {listed([*held]) or 'none'}"
            )
    shared = {name for name, count in Counter(names.values()).items() if count > 1}
    new = {old: name for old, name in names.items() if name in shared or known_expression(old) != name}
    rules = scene.face_rules
    return replace(
        scene,
        parts=tuple(
            replace(
                part, targets=tuple(replace(target, name=new.get(target.name, target.name)) for target in part.targets)
            )
            for part in scene.parts
        ),
        motions=tuple(
            replace(motion, weights={new.get(name, name): own for name, own in motion.weights.items()})
            for motion in scene.motions
        ),
        face_rules=replace(
            rules,
            switched=frozenset(new.get(name, name) for name in rules.switched),
            overrides={new.get(name, name): kinds for name, kinds in rules.overrides.items()},
        ),
    )
