// Stand-in. Source: Unity 6000.0, TextRendering.bindings.cs.
using System;

namespace UnityEngine
{
    public enum TextAnchor { UpperLeft, UpperCenter, UpperRight, MiddleLeft, MiddleCenter, MiddleRight, LowerLeft, LowerCenter, LowerRight }

    public sealed class Font : Object
    {
        public static event Action<Font> textureRebuilt;

        public Material material { get; set; }

        /// <summary>Not Unity's: it has needed room for more letters.</summary>
        public void Rebuild(Texture texture)
        {
            material.mainTexture = texture;
            if (textureRebuilt != null)
                textureRebuilt(this);
        }
    }

    public sealed class TextMesh : Component
    {
        public string text { get; set; }
        public Font font { get; set; }
        public int fontSize { get; set; }
        public TextAnchor anchor { get; set; }
        public float characterSize { get; set; }
        public Color color { get; set; }
    }
}
