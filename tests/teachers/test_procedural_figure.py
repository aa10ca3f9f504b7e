"""The procedural figure is the same in every release: docs and the bars of the demo's quality were measured with it.

After a change of the figure, write the golden file anew: python tests/teachers/test_procedural_figure.py
"""

from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural import procedural_character

GOLDEN = Path(__file__).parents[1] / "golden" / "procedural.npz"
BLOCK = 16  # texels along a side of what is summed
EVERY = {"vertex": 4, "frame": 8}  # kept of them
FEW = 4  # steps of 1 / 255 by which a block's sum may differ where a value is rounded the other way


def kept() -> dict[str, Array]:
    """Enough of the figure that no part of it can change unseen."""
    figure = procedural_character()
    assert figure.looseness is not None
    sides = [length // BLOCK for length in figure.base_color.shape[:2]]
    blocks = figure.base_color.astype(np.int64).reshape(sides[0], BLOCK, sides[1], BLOCK, -1).sum(axis=(1, 3))
    vertex, frame = slice(None, None, EVERY["vertex"]), slice(None, None, EVERY["frame"])
    found = {
        "vertices": figure.mesh.vertices[vertex],
        "uv": figure.mesh.uv[vertex],
        "faces": figure.mesh.faces.sum(axis=1)[vertex],
        "skin": (figure.skin_weights * (1 + figure.skin_indices)).sum(axis=1)[vertex],
        "looseness": figure.looseness[vertex],
        "joints": figure.skeleton.bind_translations,
        "colours": blocks,
    }
    for clip in figure.clips:
        found[f"{clip.name} rotations"] = clip.rotations[frame]
        found[f"{clip.name} root"] = clip.translations[frame, figure.skeleton.root]
    return {name: values.astype(np.int32 if values.dtype.kind == "i" else np.float32) for name, values in found.items()}


def test_the_figure_is_that_of_the_golden_file() -> None:
    found = kept()
    with np.load(GOLDEN) as golden:
        assert set(found) == set(golden.files)
        for name in golden.files:
            bound = FEW if name == "colours" else 1e-5  # float32, of metres and of numbers up to a few hundred
            np.testing.assert_allclose(found[name], golden[name], rtol=1e-5, atol=bound, err_msg=name)


if __name__ == "__main__":
    np.savez_compressed(GOLDEN, **kept())  # type: ignore[arg-type]
