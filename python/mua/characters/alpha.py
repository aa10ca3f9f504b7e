"""What becomes of a material's alpha: what its file says, unless that hides the figure or the user says otherwise."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from pathlib import Path
from typing import Literal, TypeAlias, get_args

import numpy as np

from mua.atlas.pictures import opaque
from mua.characters.messages import Messages, listed
from mua.errors import InputError
from mua.scene import AlphaMode, Material, Part, Scene

Alpha: TypeAlias = Literal["opaque", "cut", "blend", "skip"]
Alphas: TypeAlias = Mapping[str, Alpha]  # by the name of a material

NOTHING_SAID: Alphas = {}
MODES: dict[Alpha, AlphaMode] = {"opaque": "opaque", "cut": "mask", "blend": "blend"}
FEWEST = 0.05  # share of the triangles: where a file's alphas leave fewer to be seen, they mean nothing
HIDING = "Alpha would hide the figure and is ignored (--alpha MATERIAL=blend or =cut heeds it), in materials: {}."
TREATED = "Transparent materials (--alpha MATERIAL=opaque, cut, blend or skip treats one otherwise): {}."


def read_alphas(texts: Sequence[str]) -> dict[str, Alpha]:
    """Parse `hair=cut` and the like; raises an InputError for what is not one of the four, or a name given twice."""
    found: dict[str, Alpha] = {}
    for text in texts:
        name, _, treated = text.rpartition("=")
        alpha = next((one for one in get_args(Alpha) if one == treated), None)
        if not name or alpha is None:
            raise InputError(
                f"--alpha {text}: expected a material and one of {', '.join(get_args(Alpha))}, such as hair=cut"
            )
        if name.lower() in map(str.lower, found):
            raise InputError(f"--alpha {text}: {name} is named more than once")
        found[name] = alpha
    return found


def with_stated_opacity(material: Material, opacity: float) -> Material:
    """The material with an opacity that its file states as a number, beside which the image's alpha does not count.

    Where it is 0 or 1 the image keeps that alpha, for a user who asks for it.
    """
    if opacity >= 1:
        return replace(material, alpha_mode="opaque")
    image = material.image if opacity <= 0 else opaque(material.image)
    return replace(material, image=image, opacity=opacity)


def with_alphas(scene: Scene, alphas: Alphas, path: Path) -> Scene:
    """The scene with the opacity of each material in its image, less those to skip; notes say what is transparent.

    Names count in upper or lower case. Raises an InputError that names `path` and the materials there are, where none
    has one of the names.
    """
    names = tuple(dict.fromkeys(scene.materials[part.material].name for part in scene.parts))
    for name, alpha in alphas.items():
        if name.lower() not in {there.lower() for there in names}:
            raise InputError(
                f"{path}: --alpha {name}={alpha}: no material has this name; there are {_nearest_first(name, names)}"
            )
    asked = {name.lower(): alpha for name, alpha in alphas.items()}
    of = [asked.get(material.name.lower()) for material in scene.materials]
    parts = tuple(part for part in scene.parts if of[part.material] != "skip")
    materials = [_asked(material, alpha) for material, alpha in zip(scene.materials, of, strict=True)]
    ignored = Messages()
    for m in _hiding(parts, materials, {m for m, alpha in enumerate(of) if alpha is None}):
        materials[m] = replace(materials[m], alpha_mode="opaque")
        ignored.add(HIDING, materials[m].name)
    parts = tuple(_without_opacity(part) if materials[part.material].alpha_mode == "opaque" else part for part in parts)
    materials = [_settled(material) for material in materials]
    treated = dict.fromkeys(_treated(part, materials[part.material]) for part in parts)
    clear = [TREATED.format(", ".join(filter(None, treated)))] if any(treated) else []
    notes = (*scene.notes, *ignored.notes(), *clear)
    return replace(scene, parts=parts, materials=tuple(materials), notes=notes)


def _asked(material: Material, alpha: Alpha | None) -> Material:
    """The material as a user asks for it, whose word counts more than an opacity of 0."""
    if alpha is None or alpha == "skip":
        return material
    return replace(material, alpha_mode=MODES[alpha], opacity=material.opacity or 1.0)


def _hiding(parts: Sequence[Part], materials: Sequence[Material], doubted: set[int]) -> list[int]:
    """Those of the materials `doubted` that show nothing, where hardly anything else of a figure shows either."""
    clear = [part for part in parts if _most_opaque(part, materials[part.material]) < materials[part.material].least]
    hidden, count = (sum(len(part.faces) for part in some) for some in (clear, parts))
    few_seen = count - hidden < FEWEST * count
    return sorted({part.material for part in clear} & doubted) if few_seen else []


def _settled(material: Material) -> Material:
    """The material with all of its opacity in the image."""
    if material.alpha_mode == "opaque":
        return replace(material, image=opaque(material.image), opacity=1.0)
    alpha = np.rint(material.image[..., 3] * np.clip(material.opacity, 0, 1)).astype(np.uint8)
    return replace(material, image=np.dstack([material.image[..., :3], alpha]), opacity=1.0)


def _most_opaque(part: Part, material: Material) -> float:
    """The largest opacity of a part, of 255."""
    if material.alpha_mode == "opaque":
        return 255.0
    own = 1.0 if part.colors is None else float(part.colors[..., 3].max(initial=0))
    return float(material.image[..., 3].max()) * material.opacity * own


def _without_opacity(part: Part) -> Part:
    """The part with vertex colours that are opaque."""
    if part.colors is None:
        return part
    colors = part.colors.copy()
    colors[..., 3] = 1
    return replace(part, colors=None if (colors == 1).all() else colors)


def _treated(part: Part, material: Material) -> str:
    """How the alpha of a part is treated, such as `hair cut at 0.5`; empty where it is opaque."""
    least = float(material.image[..., 3].min()) * (1.0 if part.colors is None else part.colors[..., 3].min(initial=1))
    if material.alpha_mode == "mask":
        return f"{material.name} cut at {material.alpha_cutoff:g}" if least < material.least else ""
    return f"{material.name} blended" if least < 255 else ""


def _nearest_first(name: str, names: Sequence[str]) -> str:
    """The names as an enumeration, those most like `name` first."""
    return listed(sorted(names, key=lambda one: -SequenceMatcher(None, name.lower(), one.lower()).ratio()))
