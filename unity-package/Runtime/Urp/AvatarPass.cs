using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.Rendering.RenderGraphModule;
using UnityEngine.Rendering.Universal;

namespace Mua
{
    /// <summary>
    /// A pass of one camera at a time. URP leaves a pass in its queue when the camera turns out to have nothing to render,
    /// and finds it there again with the next camera: it is recorded once, for the camera that it was last enqueued for.
    /// </summary>
    internal abstract class AvatarPass : ScriptableRenderPass
    {
        private Camera awaited;

        protected AvatarPass(string name, RenderPassEvent moment)
        {
            renderPassEvent = moment;
            profilingSampler = new ProfilingSampler(name);
            Name = name;
        }

        protected string Name { get; }

        public void Enqueue(ScriptableRenderer renderer, Camera camera)
        {
            awaited = camera;
            renderer.EnqueuePass(this);
        }

        public sealed override void RecordRenderGraph(RenderGraph graph, ContextContainer frame)
        {
            UniversalCameraData camera = frame.Get<UniversalCameraData>();
            AvatarWorld world = AvatarWorld.Current; // it may have gone since the camera began
            if (world != null && ReferenceEquals(awaited, camera.camera))
            {
                awaited = null;
                Record(graph, frame, camera, world);
            }
        }

        protected abstract void Record(
            RenderGraph graph, ContextContainer frame, UniversalCameraData camera, AvatarWorld world);
    }
}
