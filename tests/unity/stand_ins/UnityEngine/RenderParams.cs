// Stand-in. Source: Unity 6000.0 scripting reference, RenderParams, ShadowCastingMode.
namespace UnityEngine.Rendering
{
    public enum ShadowCastingMode { Off, On, TwoSided, ShadowsOnly }
}

namespace UnityEngine
{
    public struct RenderParams
    {
        public RenderParams(Material mat) : this() { material = mat; }

        public int layer { get; set; }
        public Bounds worldBounds { get; set; }
        public Material material { get; set; }
        public MaterialPropertyBlock matProps { get; set; }
        public Rendering.ShadowCastingMode shadowCastingMode { get; set; }
        public bool receiveShadows { get; set; }
        public bool overrideSceneCullingMask { get; set; }
        public ulong sceneCullingMask { get; set; }
    }
}
