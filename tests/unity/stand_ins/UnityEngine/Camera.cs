// Stand-in. Source: facts 4.4, Unity 6000.0, Camera, GL; scripting reference, Mesh, Renderer, Animator.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public enum CameraClearFlags { Skybox = 1, SolidColor, Depth, Nothing }

    public sealed class Camera : Behaviour
    {
        public enum StereoscopicEye { Left, Right }
        public enum MonoOrStereoscopicEye { Left, Right, Mono }
        public delegate void CameraCallback(Camera cam);

        public static CameraCallback onPreCull, onPreRender, onPostRender;

        internal readonly List<Rendering.CommandBuffer> Buffers = new List<Rendering.CommandBuffer>();
        private Matrix4x4 projection = Matrix4x4.Perspective(60, 4f / 3, 0.3f, 1000);

        public Camera()
        {
            cullingMask = -1;
            nearClipPlane = 0.3f;
            farClipPlane = 1000;
            fieldOfView = 60;
            cameraType = CameraType.Game;
        }

        public static Camera main { get { return FindFirstObjectByType<Camera>(); } }
        public int pixelWidth { get { return 640; } }
        public int pixelHeight { get { return 480; } }
        public float fieldOfView { get; set; }
        public float nearClipPlane { get; set; }
        public float farClipPlane { get; set; }
        public int cullingMask { get; set; }
        public CameraClearFlags clearFlags { get; set; }
        public Color backgroundColor { get; set; }
        public bool allowHDR { get; set; }
        public bool allowMSAA { get; set; }
        public CameraType cameraType { get; set; }
        public bool stereoEnabled { get; internal set; }
        public MonoOrStereoscopicEye stereoActiveEye { get { return MonoOrStereoscopicEye.Mono; } }
        public Matrix4x4 worldToCameraMatrix { get { return Matrix4x4.Scale(new Vector3(1, 1, -1)) * transform.worldToLocalMatrix; } }
        public Matrix4x4 projectionMatrix { get { return projection; } set { projection = value; } }
        public Matrix4x4 GetStereoViewMatrix(StereoscopicEye eye)
        {
            return Matrix4x4.Translate(new Vector3(eye == StereoscopicEye.Left ? 0.0315f : -0.0315f, 0, 0)) * worldToCameraMatrix;
        }
        public void AddCommandBuffer(Rendering.CameraEvent evt, Rendering.CommandBuffer buffer) { Buffers.Add(buffer); }
        public void RemoveCommandBuffer(Rendering.CameraEvent evt, Rendering.CommandBuffer buffer) { Buffers.Remove(buffer); }
        public Matrix4x4 GetStereoProjectionMatrix(StereoscopicEye eye) { return projection; }
        public void Render()
        {
            if (onPreCull != null)
                onPreCull(this);
            if (onPreRender != null)
                onPreRender(this);
            for (int i = 0; i < Buffers.Count; i++)
                Graphics.ExecuteCommandBuffer(Buffers[i]);
            if (onPostRender != null)
                onPostRender(this);
        }
    }

    public static class GL
    {
        /// <summary>Vulkan: y down, depth reversed from 1 to 0.</summary>
        public static Matrix4x4 GetGPUProjectionMatrix(Matrix4x4 proj, bool renderIntoTexture)
        {
            if (renderIntoTexture)
                proj.SetRow(1, -proj.GetRow(1));
            proj.SetRow(2, (proj.GetRow(3) - proj.GetRow(2)) * 0.5f);
            return proj;
        }
    }

    public sealed class Mesh : Object
    {
        public Bounds bounds { get; set; }
    }

    public sealed class MeshFilter : Component { public Mesh sharedMesh { get; set; } }
    public class Renderer : Component { public Material sharedMaterial { get; set; } public bool enabled { get; set; } }
    public sealed class MeshRenderer : Renderer { }
    public class Animator : Behaviour { }
}
