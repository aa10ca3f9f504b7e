// Stand-in. Source: Unity's Graphics repository, com.unity.render-pipelines.universal 17.0, Runtime:
// UniversalRenderPipeline.cs (RenderCameraStack, RenderSingleCamera), UniversalRendererRenderGraph.cs (OnRecordRenderGraph),
// Data/UniversalRenderPipelineAsset.cs, UniversalAdditionalCameraData.cs, Settings/RenderGraphSettings.cs.
using System;
using System.Collections.Generic;
using UnityEngine.Experimental.Rendering;
using UnityEngine.Rendering.RenderGraphModule;

namespace UnityEngine.Rendering.Universal
{
#if UNITY_6000_4_OR_NEWER
    [Obsolete("These settings are not used.", false)]
#endif
    public class RenderGraphSettings : IRenderPipelineGraphicsSettings
    {
        public int version { get { return 0; } }
#if UNITY_6000_4_OR_NEWER
        [Obsolete("This property is not used.", false)]
        public bool enableRenderCompatibilityMode { get { return false; } }
#elif UNITY_6000_3_OR_NEWER && !URP_COMPATIBILITY_MODE
        public bool enableRenderCompatibilityMode { get { return false; } } // Unity's has a setter that is an error to use
#else
        public bool enableRenderCompatibilityMode { get; set; }
#endif
    }

    public partial class UniversalRenderPipelineAsset : RenderPipelineAsset
    {
        private readonly ScriptableRenderer renderer = new ScriptableRenderer();

        public ScriptableRenderer scriptableRenderer { get { return renderer; } }
        public float renderScale { get; set; }
    }

    public sealed class UniversalRenderPipeline
    {
        public static UniversalRenderPipelineAsset asset { get { return GraphicsSettings.currentRenderPipeline as UniversalRenderPipelineAsset; } }
    }

    public enum CameraRenderType { Base, Overlay }

    public class UniversalAdditionalCameraData : MonoBehaviour
    {
        private readonly List<Camera> stack = new List<Camera>();

        public ScriptableRenderer Own; // not Unity's: it has SetRenderer(int)

        public CameraRenderType renderType { get; set; }
        public List<Camera> cameraStack { get { return stack; } }
        public ScriptableRenderer scriptableRenderer { get { return UniversalRenderPipeline.asset == null ? null : Own ?? UniversalRenderPipeline.asset.scriptableRenderer; } }
    }
}

namespace StandIns
{
    using UnityEngine;
    using UnityEngine.Rendering;
    using UnityEngine.Rendering.Universal;

    /// <summary>Draws cameras in URP's order: every eye pass begins the camera, and is submitted before the next.</summary>
    public sealed class Universal
    {
        private readonly RenderGraph graph = new RenderGraph();
        private readonly CommandBuffer commands = new CommandBuffer();
        private readonly XRPass xr = new XRPass();
        private readonly Action<CommandBuffer> start, stop;
        private readonly UniversalRenderPipelineAsset asset;

        /// <summary>Cameras that turn out to have nothing to render, after they began.</summary>
        public readonly HashSet<Camera> Culled = new HashSet<Camera>();

        /// <summary>Between the recording of a graph and its execution.</summary>
        public Action BeforeExecute;

        public bool HasColor = true, IsBackBuffer;
        public float RenderScale = 1;
        public bool UsesDynamicScale;

        public Universal()
        {
            start = xr.StartSinglePass;
            stop = xr.StopSinglePass;
            asset = ScriptableObject.CreateInstance<UniversalRenderPipelineAsset>();
            Pipelines.Use(asset);
            Pipelines.Render = Render;
        }

        public void Remove()
        {
            Pipelines.Use(null);
            Pipelines.Render = null;
        }

        private void Render(Camera camera)
        {
            UniversalAdditionalCameraData data;
            camera.TryGetComponent(out data);
            if (data != null && data.renderType == CameraRenderType.Overlay)
                return;
            bool twice = camera.stereoEnabled && Eyes.IsMultiPass;
            for (int pass = 0; pass < (twice ? 2 : 1); pass++)
            {
                RenderSingle(camera, data, camera, pass, twice);
                for (int i = 0; data != null && i < data.cameraStack.Count; i++)
                {
                    UniversalAdditionalCameraData overlay;
                    data.cameraStack[i].TryGetComponent(out overlay);
                    RenderSingle(data.cameraStack[i], overlay, camera, pass, twice);
                }
            }
        }

        private void RenderSingle(Camera camera, UniversalAdditionalCameraData data, Camera stereo, int pass, bool twice)
        {
            Pipelines.Begin(camera);
            xr.Set(camera, pass, pass, !stereo.stereoEnabled ? 0 : twice ? 1 : 2);
            if (!Culled.Contains(camera))
            {
                ScriptableRenderer renderer = data != null ? data.scriptableRenderer : null;
                if (renderer == null || camera.cameraType == CameraType.SceneView)
                    renderer = asset.scriptableRenderer;
                Record(renderer, camera);
                if (BeforeExecute != null)
                    BeforeExecute();
                graph.Execute(commands);
                renderer.Finish();
                Graphics.ExecuteCommandBuffer(commands);
                commands.Clear();
                if (Recorder.IsOn)
                    Recorder.Note("submit " + camera.name);
            }
            Pipelines.End(camera);
        }

        private void Record(ScriptableRenderer renderer, Camera camera)
        {
            UniversalCameraData data = renderer.Frame.GetOrCreate<UniversalCameraData>();
            data.camera = camera;
            data.cameraType = camera.cameraType;
            data.renderScale = RenderScale;
            data.xr = xr;
            data.cameraTargetDescriptor = new RenderTextureDescriptor
            {
                width = xr.enabled ? Eyes.Width : (int)(camera.pixelWidth * RenderScale),
                height = xr.enabled ? Eyes.Height : (int)(camera.pixelHeight * RenderScale),
                useDynamicScale = xr.enabled || UsesDynamicScale,
            };
            UniversalResourceData targets = renderer.Frame.GetOrCreate<UniversalResourceData>();
            targets.Accessible = true;
            targets.HasColor = HasColor;
            targets.IsBackBuffer = IsBackBuffer;
            renderer.Sort();
            renderer.Record(graph, RenderPassEvent.BeforeRendering, RenderPassEvent.BeforeRenderingShadows);
            graph.AddStep(start);
            renderer.Record(graph, RenderPassEvent.BeforeRenderingOpaques, RenderPassEvent.AfterRendering);
            graph.AddStep(stop);
            targets.Accessible = false;
        }
    }
}
