"""Sizes of students on the measured frontier of error against cost, and the largest of them within a budget."""

from dataclasses import asdict, replace

from mua.asset.count import flops, parameters
from mua.asset.tensors import Storage
from mua.errors import InputError
from mua.student.settings import LEAN_SIZES, Budget, Ranks, Settings, Sizes
from mua.student.shapes import Body, outline

# Bytes of a file beside what is learnt.
TEXEL_BYTES = 17.5  # where a valid texel lies on the template, and its share of the surface
VERTEX_BYTES = 125  # a vertex of the template with its weights and triangles
OTHER_BYTES = 50_000  # joints, thumbnail, names


# From docs/research/ranks.md; each costs more than the one before it, and its bases hold more.
FRONTIER = (
    Sizes(Ranks(8, 8, 8), Ranks(16, 16, 8), components=32, hidden=128),
    Sizes(Ranks(8, 16, 8), Ranks(32, 32, 8), components=48, hidden=128),
    Sizes(Ranks(16, 16, 8), Ranks(32, 64, 16), components=64, hidden=192),
    Sizes(Ranks(16, 32, 16), Ranks(48, 96, 32), components=72, hidden=192),
    Sizes(Ranks(16, 64, 16), Ranks(48, 128, 64), components=72, hidden=192),
    Sizes(Ranks(24, 64, 16), Ranks(64, 192, 64), components=72, hidden=192),
    LEAN_SIZES,
    Sizes(Ranks(32, 96, 32), Ranks(96, 256, 64), components=96, hidden=256),
    Sizes(Ranks(64, 128, 64), Ranks(128, 256, 96), components=128, hidden=384),
)


def within_budget(settings: Settings, body: Body, storage: Storage) -> Settings:
    """The settings with the largest sizes of the frontier that keep their budget; as they are where they have none.

    Raises InputError where not even the smallest sizes do.
    """
    if not settings.budget:
        return settings
    smallest, *_ = fitted = [replace(settings, budget=Budget(), **vars(sizes)) for sizes in FRONTIER]
    costs = [cost(each, body, storage) for each in fitted]
    kept = [each for each, own in zip(fitted, costs, strict=True) if not _excess(own, settings.budget)]
    if kept:
        return kept[-1]
    name, unit = _excess(costs[0], settings.budget)[0]
    given, least = (getattr(of, name) for of in (settings.budget, costs[0]))
    raise InputError(
        f"--budget-{name} {given:g}: the smallest student takes {least:.4g} {unit} with {smallest.texels} texels along "
        "a side; give at least that, or fewer --texels"
    )


def cost(settings: Settings, body: Body, storage: Storage) -> Budget:
    """What the avatar costs: at least that where some of the body is not known, at most where all of it is."""
    student = outline(settings, body)
    learnt = sum(parameters(student).values()) + student.components.directions.size
    size = (
        learnt * (4 if storage == "f32" else 2) + TEXEL_BYTES * body.texels + VERTEX_BYTES * body.vertices + OTHER_BYTES
    )
    return Budget(mflop=sum(flops(student).values()) / 1e6, mb=size / 1e6)


def describe_sizes(settings: Settings) -> str:
    """Ranks, components and width for a note."""
    ranks = (" ".join(map(str, asdict(own).values())) for own in (settings.geometry, settings.appearance))
    geometry, appearance = ranks
    return (
        f"ranks of {geometry} (geometry) and {appearance} (appearance) for LL, D3 and D2, {settings.components} "
        f"components of the mesh and hidden layers of {settings.hidden}"
    )


def _excess(spent: Budget, most: Budget) -> list[tuple[str, str]]:
    """Name and unit of what is over the budget."""
    units = {"mflop": "million operations a frame", "mb": "megabytes"}
    limits = vars(most)
    return [(name, unit) for name, unit in units.items() if (limits[name] or float("inf")) < getattr(spent, name)]
