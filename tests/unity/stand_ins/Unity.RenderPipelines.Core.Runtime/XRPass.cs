// Stand-in. Source: Unity's Graphics repository, com.unity.render-pipelines.core 17.0, Runtime/XR/XRPass.cs,
// XRSystem.cs: the views that one pass over a camera draws.
using UnityEngine.Rendering;

namespace UnityEngine.Experimental.Rendering
{
    public static class XRSystem
    {
        public static float GetRenderViewportScale() { return StandIns.Eyes.Scale; }
    }

    public class XRPass
    {
        private readonly Matrix4x4[] views = new Matrix4x4[2], projections = new Matrix4x4[2];

        public bool enabled { get { return viewCount > 0; } }
        public bool singlePassEnabled { get { return viewCount > 1; } }
        public bool supportsFoveatedRendering { get { return enabled; } }
        public int viewCount { get; private set; }
        public int multipassId { get; private set; }
        public Matrix4x4 GetProjMatrix(int viewIndex = 0) { return projections[viewIndex]; }
        public Matrix4x4 GetViewMatrix(int viewIndex = 0) { return views[viewIndex]; }

        public void StartSinglePass(CommandBuffer cmd)
        {
            if (singlePassEnabled && !SystemInfo.supportsMultiview)
                cmd.SetInstanceMultiplier((uint)viewCount);
        }

        public void StopSinglePass(CommandBuffer cmd)
        {
            if (singlePassEnabled && !SystemInfo.supportsMultiview)
                cmd.SetInstanceMultiplier(1);
        }

        /// <summary>Not Unity's: so many eyes of the headset from a first one.</summary>
        public void Set(Camera camera, int multipassId, int first, int count)
        {
            this.multipassId = multipassId;
            viewCount = count;
            for (int i = 0; i < count; i++)
            {
                views[i] = StandIns.Eyes.View(camera, first + i);
                projections[i] = StandIns.Eyes.Projection(camera, first + i);
            }
        }
    }
}
