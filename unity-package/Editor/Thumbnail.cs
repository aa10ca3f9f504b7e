using Mua.Format;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>A picture of an avatar: the PNG that the file brings, or else a portrait.</summary>
    internal static class Thumbnail
    {
        private const int Size = 128; // pixels, of a portrait

        public static Texture2D Of(AvatarFile avatar)
        {
            var texture = new Texture2D(Size, Size, TextureFormat.RGBA32, false);
            if (avatar.Thumbnail.Count > 0 && texture.LoadImage(avatar.Thumbnail.ToArray()))
            {
                return texture;
            }
            Object.DestroyImmediate(texture); // a PNG that fails has left its mark in it
            texture = new Texture2D(Size, Size, TextureFormat.RGBA32, false);
            texture.LoadRawTextureData(Portrait.Draw(avatar, Size));
            texture.Apply();
            return texture;
        }
    }
}
