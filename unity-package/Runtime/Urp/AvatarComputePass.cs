using UnityEngine;
using UnityEngine.Experimental.Rendering;
using UnityEngine.Rendering;
using UnityEngine.Rendering.RenderGraphModule;
using UnityEngine.Rendering.Universal;

namespace Mua
{
    /// <summary>
    /// Poses what moved and sorts for the eyes of a camera, before its shadow maps and outside every native render pass.
    /// </summary>
    /// <remarks>
    /// The buffers are those of the world and outlive the graph, which does not see them: the pass is kept by
    /// AllowPassCulling(false), and its place before the draw is the order of recording, which the graph never changes.
    /// All cameras share the buffers. URP executes and submits the graph of a camera before the next one begins, so the
    /// dispatches of a second camera come after the draws of the first.
    /// </remarks>
    internal sealed class AvatarComputePass : AvatarPass
    {
        private static readonly BaseRenderFunc<Data, UnsafeGraphContext> Run = Execute;

        private readonly AvatarEyes eyes = new AvatarEyes(); // of the camera that is recorded

        public AvatarComputePass()
            : base("MUA compute", RenderPassEvent.BeforeRendering)
        {
        }

        protected override void Record(
            RenderGraph graph, ContextContainer frame, UniversalCameraData camera, AvatarWorld world)
        {
            Take(camera);
            using (IUnsafeRenderGraphBuilder builder = graph.AddUnsafePass(Name, out Data data, profilingSampler))
            {
                data.World = world;
                data.Camera = camera.camera;
                data.Eyes = eyes;
                builder.AllowPassCulling(false);
                builder.SetRenderFunc(Run);
            }
        }

        private static void Execute(Data data, UnsafeGraphContext context)
        {
            CommandBuffer commands = CommandBufferHelpers.GetNativeCommandBuffer(context.cmd);
            data.World.Record(commands, data.Camera, data.Eyes); // nothing, where the world has gone meanwhile
        }

        /// <summary>
        /// Both eyes in one pass, or the single eye of this pass. Where instances draw both, URP multiplies the instances
        /// of direct draws, but not those that the device reads from a buffer.
        /// </summary>
        private void Take(UniversalCameraData camera)
        {
            int count = camera.xr.enabled ? Mathf.Min(camera.xr.viewCount, AvatarEyes.Most) : 1;
            RenderTextureDescriptor target = camera.cameraTargetDescriptor;
            Vector2 scale = target.useDynamicScale ? Scale(camera) : Vector2.one;
            eyes.Begin(
                Mathf.CeilToInt(scale.x * target.width), Mathf.CeilToInt(scale.y * target.height),
                camera.camera.nearClipPlane, SystemInfo.supportsMultiview ? 1 : count);
            for (int eye = 0; eye < count; eye++)
            {
                eyes.Add(camera.GetViewMatrix(eye), camera.GetProjectionMatrix(eye));
            }
        }

        /// <summary>Share of a target's pixels that are drawn; a headset has a scale of its own, which URP reads in the same way.</summary>
        private static Vector2 Scale(UniversalCameraData camera)
        {
            return camera.xr.enabled
                ? XRSystem.GetRenderViewportScale() * Vector2.one
                : new Vector2(ScalableBufferManager.widthScaleFactor, ScalableBufferManager.heightScaleFactor);
        }

        private sealed class Data
        {
            public AvatarWorld World;
            public Camera Camera;
            public AvatarEyes Eyes;
        }
    }
}
