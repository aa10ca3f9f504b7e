// Stand-in. Source: Unity's Graphics repository, com.unity.render-pipelines.universal 17.0, Data/UniversalRenderPipelineAsset.cs,
// UniversalRendererData.cs, PostProcessData.cs; values of a new asset.
namespace UnityEngine.Rendering.Universal
{
    public abstract class ScriptableRendererData : ScriptableObject { }

    public class PostProcessData : ScriptableObject { }

    public class UniversalRendererData : ScriptableRendererData { public PostProcessData postProcessData; }

    public partial class UniversalRenderPipelineAsset
    {
        public UniversalRenderPipelineAsset()
        {
            supportsHDR = supportsCameraDepthTexture = supportsCameraOpaqueTexture = true;
            msaaSampleCount = 4;
        }

        public bool supportsHDR { get; set; }
        public bool supportsCameraDepthTexture { get; set; }
        public bool supportsCameraOpaqueTexture { get; set; }
        public int msaaSampleCount { get; set; }
        public static UniversalRenderPipelineAsset Create(ScriptableRendererData rendererData = null)
        {
            return CreateInstance<UniversalRenderPipelineAsset>();
        }
    }
}
