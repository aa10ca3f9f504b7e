"""From a dense character to the rig of its student: template and texel map."""

from mua.arrays import Array
from mua.rig.character import Character
from mua.rig.rig import Rig
from mua.rig.template import make_template
from mua.rig.texel_binding import bind_texels


def build_rig(character: Character, *, texels: int, template_vertices: int = 5000) -> tuple[Rig, Array]:
    """Make the template of a character and the map of `texels` x `texels` texels on it.

    Also returns the dense vertex of each template vertex, [V] int32.
    """
    template = make_template(character, vertices=template_vertices)
    rig = Rig(
        skeleton=character.skeleton,
        mesh=template.mesh,
        skin_indices=template.skin_indices,
        skin_weights=template.skin_weights,
        texels=bind_texels(character, template, size=texels).kept,
        expressions=None if character.expressions is None else character.expressions.at(template.source_vertices),
    )
    return rig, template.source_vertices
