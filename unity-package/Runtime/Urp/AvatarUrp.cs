using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.Rendering.Universal;

namespace Mua
{
    /// <summary>
    /// Draws the world of avatars in the Universal Render Pipeline. It hands its passes to the renderer of each camera that
    /// begins, once for each eye where eyes are drawn one after the other, so that no renderer asset has to name them.
    /// </summary>
    internal static class AvatarUrp
    {
        private const string NeedsRenderGraph =
            "URP runs in Compatibility Mode, in which avatars are not drawn; turn it off in Project Settings > Graphics > "
            + "Render Graph.";

        private static AvatarComputePass compute;
        private static AvatarDrawPass draw;

#if UNITY_EDITOR
        [UnityEditor.InitializeOnLoadMethod]
#endif
        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        internal static void Install()
        {
            RenderPipelineManager.beginCameraRendering -= BeforeCamera; // both attributes call it in the editor
            RenderPipelineManager.beginCameraRendering += BeforeCamera;
        }

        private static void BeforeCamera(ScriptableRenderContext context, Camera camera)
        {
            AvatarWorld world = AvatarWorld.Current;
            if (world == null || !world.IsSeen(camera))
            {
                return;
            }
            ScriptableRenderer renderer = RendererOf(camera);
            if (renderer == null || !HasRenderGraph())
            {
                return;
            }
            if (compute == null)
            {
                compute = new AvatarComputePass();
                draw = new AvatarDrawPass();
            }
            compute.Enqueue(renderer, camera);
            draw.Enqueue(renderer, camera);
        }

        /// <summary>The renderer that URP itself takes for a camera; null in another pipeline.</summary>
        private static ScriptableRenderer RendererOf(Camera camera)
        {
            UniversalRenderPipelineAsset pipeline = UniversalRenderPipeline.asset;
            if (pipeline == null)
            {
                return null;
            }
            ScriptableRenderer own = null;
            if (camera.cameraType != CameraType.SceneView
                && camera.TryGetComponent(out UniversalAdditionalCameraData settings))
            {
                own = settings.scriptableRenderer;
            }
            return own ?? pipeline.scriptableRenderer;
        }

        private static bool HasRenderGraph()
        {
#if !UNITY_6000_4_OR_NEWER // from there on URP has nothing else
            if (GraphicsSettings.TryGetRenderPipelineSettings(out RenderGraphSettings settings)
                && settings.enableRenderCompatibilityMode)
            {
                AvatarWorld.Report(NeedsRenderGraph, null);
                return false;
            }
#endif
            return true;
        }
    }
}
