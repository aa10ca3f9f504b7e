// Stand-in. Source: Unity 6000.0 scripting reference, Light.
namespace UnityEngine
{
    public enum LightType { Spot, Directional, Point }
    public enum LightShadows { None, Hard, Soft }

    public sealed class Light : Behaviour
    {
        public LightType type { get; set; }
        public LightShadows shadows { get; set; }
        public Color color { get; set; }
    }
}
