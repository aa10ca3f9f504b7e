// Stand-in. Source: Unity's Graphics repository, com.unity.render-pipelines.universal 17.0, Runtime:
// ScriptableRenderer.cs, Passes/ScriptableRenderPass.cs.
using System.Collections.Generic;
using UnityEngine.Rendering.RenderGraphModule;

namespace UnityEngine.Rendering.Universal
{
    public enum RenderPassEvent
    {
        BeforeRendering = 0, BeforeRenderingShadows = 50, BeforeRenderingOpaques = 250, AfterRenderingOpaques = 300,
        BeforeRenderingTransparents = 450, AfterRenderingTransparents = 500, AfterRendering = 1000
    }

    public abstract class ScriptableRenderPass
    {
        public RenderPassEvent renderPassEvent { get; set; }
        protected internal ProfilingSampler profilingSampler { get; set; }
        public virtual void RecordRenderGraph(RenderGraph renderGraph, ContextContainer frameData) { }
    }

    public class ScriptableRenderer
    {
        internal readonly ContextContainer Frame = new ContextContainer();
        private readonly List<ScriptableRenderPass> queue = new List<ScriptableRenderPass>();

        public void EnqueuePass(ScriptableRenderPass pass) { queue.Add(pass); }

        /// <summary>By event, those of one event as they were enqueued.</summary>
        internal void Sort()
        {
            for (int i = 1; i < queue.Count; i++)
            {
                ScriptableRenderPass pass = queue[i];
                int at = i;
                for (; at > 0 && queue[at - 1].renderPassEvent > pass.renderPassEvent; at--)
                    queue[at] = queue[at - 1];
                queue[at] = pass;
            }
        }

        internal void Record(RenderGraph graph, RenderPassEvent from, RenderPassEvent to)
        {
            for (int i = 0; i < queue.Count; i++)
                if (queue[i].renderPassEvent >= from && queue[i].renderPassEvent < to)
                    queue[i].RecordRenderGraph(graph, Frame);
        }

        internal void Finish() { queue.Clear(); }
    }
}
