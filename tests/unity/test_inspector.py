"""What the inspector describes is kept in scenes: asked of the compiled assemblies."""

from package_content import Content


def test_every_field_with_a_tooltip_is_kept_in_the_scene(content: Content) -> None:
    """A private field without SerializeField is neither shown nor saved, and Unity says nothing about its tooltip."""
    assert "Mua.AvatarRenderer.spreadDecode" in content.declared["serialized"]
    assert content.declared["lost"] == []
