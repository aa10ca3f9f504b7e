"""The layers of an avatar that are shown: splats, detailed geometry, template, skeleton, shadow."""

from dataclasses import dataclass, fields, replace

from mua.errors import InputError


@dataclass(frozen=True)
class Toggles:
    """Whether each layer is shown (paper, section System)."""

    splats: bool = True
    geometry: bool = False  # the texel grid as a lit mesh
    template: bool = False
    skeleton: bool = False
    shadow: bool = False


def parse_toggles(text: str) -> Toggles:
    """The toggles that a list such as `splats,shadow` names.

    Errors: InputError for an unknown word.
    """
    names = [field.name for field in fields(Toggles)]
    shown = [word.strip() for word in text.split(",")]
    unknown = [word for word in shown if word not in names]
    if unknown:
        raise InputError(f"--show is {text!r}; expected some of {', '.join(names)}, separated by commas")
    return replace(Toggles(), **{name: name in shown for name in names})
