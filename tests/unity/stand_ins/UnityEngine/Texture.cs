// Stand-in. Source: Unity 6000.0 scripting reference, Texture, Texture2D, TextureFormat, ImageConversion.
namespace UnityEngine
{
    public enum TextureFormat { Alpha8 = 1, RGB24 = 3, RGBA32 = 4, ARGB32 = 5 }

    public class Texture : Object
    {
        public virtual int width { get; protected set; }
        public virtual int height { get; protected set; }
    }

    public sealed class Texture2D : Texture
    {
        public Texture2D(int width, int height)
        {
            this.width = width;
            this.height = height;
            mipmapCount = 2; // more than one; this stand-in makes none
            StandIns.Textures.Alive++;
        }

        public Texture2D(int width, int height, TextureFormat textureFormat, bool mipChain) : this(width, height)
        {
            format = textureFormat;
            mipmapCount = mipChain ? mipmapCount : 1;
        }

        public TextureFormat format { get; private set; }
        public int mipmapCount { get; private set; }

        internal override void OnDestroyed() { StandIns.Textures.Alive--; }

        internal byte[] Content; // as it was loaded

        internal void Become(int width, int height, byte[] content)
        {
            this.width = width;
            this.height = height;
            Content = content;
        }
    }

    /// <summary>Reads no more of a PNG than that it is whole: signature, size and the chunk at its end.</summary>
    public static class ImageConversion
    {
        private const int Smallest = 57; // bytes: signature, IHDR, an empty IDAT, IEND

        public static bool LoadImage(this Texture2D tex, byte[] data)
        {
            bool whole = data.Length >= Smallest && data[data.Length - 8] == 'I' && data[data.Length - 5] == 'D';
            tex.Become(whole ? Side(data, 16) : 8, whole ? Side(data, 20) : 8, data);
            return whole;
        }

        private static int Side(byte[] data, int at)
        {
            return data[at] << 24 | data[at + 1] << 16 | data[at + 2] << 8 | data[at + 3];
        }
    }
}

namespace StandIns
{
    /// <summary>Textures that nobody has destroyed, and what was loaded into one. Not part of Unity's API.</summary>
    public static class Textures
    {
        public static int Alive;

        public static byte[] Content(UnityEngine.Texture2D texture) { return texture.Content; }
    }
}
