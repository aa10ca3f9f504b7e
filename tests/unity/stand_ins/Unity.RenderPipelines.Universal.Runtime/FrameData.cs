// Stand-in. Source: Unity's Graphics repository, com.unity.render-pipelines.universal 17.0, Runtime/FrameData:
// UniversalCameraData.cs, UniversalResourceData.cs.
using UnityEngine.Experimental.Rendering;
using UnityEngine.Rendering.RenderGraphModule;

namespace UnityEngine.Rendering.Universal
{
    public class UniversalCameraData : ContextItem
    {
        public Camera camera;
        public CameraType cameraType;
        public float renderScale;
        public RenderTextureDescriptor cameraTargetDescriptor;

        public XRPass xr { get; internal set; }
        public Matrix4x4 GetViewMatrix(int viewIndex = 0) { return xr.enabled ? xr.GetViewMatrix(viewIndex) : camera.worldToCameraMatrix; }
        public Matrix4x4 GetProjectionMatrix(int viewIndex = 0) { return xr.enabled ? xr.GetProjMatrix(viewIndex) : camera.projectionMatrix; }
        public override void Reset() { }
    }

    public class UniversalResourceData : ContextItem
    {
        internal bool Accessible, HasColor = true, IsBackBuffer;

        public TextureHandle activeColorTexture { get { return Accessible && HasColor ? TextureHandle.Of("color") : TextureHandle.nullHandle; } }
        public TextureHandle activeDepthTexture { get { return Accessible ? TextureHandle.Of("depth") : TextureHandle.nullHandle; } }
        public bool isActiveTargetBackBuffer { get { return IsBackBuffer; } }
        public override void Reset() { }
    }
}
