// Stand-in. Source: Unity 6000.0 scripting reference, CameraEvent, CameraType, GraphicsSettings, RenderPipelineAsset.
namespace UnityEngine
{
    public enum CameraType { Game = 1, SceneView = 2, Preview = 4, VR = 8, Reflection = 16 }
}

namespace UnityEngine.Rendering
{
    public enum CameraEvent { BeforeForwardOpaque = 10, AfterForwardOpaque = 11, BeforeForwardAlpha = 16, AfterForwardAlpha = 17, AfterEverything = 19 }

    public abstract class RenderPipelineAsset : ScriptableObject
    {
        public virtual Shader defaultShader { get { return null; } }
        public virtual Material defaultMaterial { get { return null; } }
    }

    public static partial class GraphicsSettings
    {
        public static RenderPipelineAsset currentRenderPipeline { get; internal set; }
        public static RenderPipelineAsset defaultRenderPipeline
        {
            get { return currentRenderPipeline; }
            set { currentRenderPipeline = value; }
        }
    }
}
