// Stand-in. Source: Unity 6000.0 scripting reference, Texture, Texture2D.
namespace UnityEngine
{
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
        }

        public void Apply() { }
    }
}
