// Stand-in. Source: Unity 6000.0, GraphicsManagers.bindings.cs, QualitySettings; two levels, the second is chosen.
using System;
using UnityEngine.Rendering;

namespace UnityEngine
{
    public static class QualitySettings
    {
        private static readonly int[] samples = { 0, 4, 0 };
        private static readonly RenderPipelineAsset[] pipelines = new RenderPipelineAsset[samples.Length];
        private static int level = 1;

        public static int count { get { return samples.Length; } }
        public static int antiAliasing { get { return samples[level]; } set { samples[level] = value; } }
        public static RenderPipelineAsset GetRenderPipelineAssetAt(int index) { return pipelines[index]; }
        public static void ForEach(Action callback)
        {
            int before = level;
            for (level = 0; level < count; level++)
                callback();
            level = before;
        }
    }
}
