// Stand-in. Source: Unity 6000.0, Camera, GL; scripting reference, Mesh, Renderer, Animator.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public enum CameraClearFlags { Skybox = 1, SolidColor, Depth, Nothing }

    public sealed class Camera : Behaviour
    {
        public enum StereoscopicEye { Left, Right }
        public delegate void CameraCallback(Camera cam);

        public static CameraCallback onPreCull, onPreRender, onPostRender;

        /// <summary>Not Unity's API.</summary>
        public int AttachedBuffers { get { return Buffers.Count; } }

        internal readonly List<Rendering.CommandBuffer> Buffers = new List<Rendering.CommandBuffer>();
        private Matrix4x4 projection = Matrix4x4.Perspective(60, 4f / 3, 0.3f, 1000);
        private Matrix4x4? view;

        public Camera()
        {
            cullingMask = -1;
            nearClipPlane = 0.3f;
            farClipPlane = 1000;
            fieldOfView = 60;
            cameraType = CameraType.Game;
        }

        public static Camera main { get { return FindAnyObjectByType<Camera>(); } }
        public int pixelWidth { get { return 640; } }
        public int pixelHeight { get { return 480; } }
        public int scaledPixelWidth { get { return Mathf.CeilToInt((allowDynamicResolution ? ScalableBufferManager.widthScaleFactor : 1) * pixelWidth); } }
        public int scaledPixelHeight { get { return Mathf.CeilToInt((allowDynamicResolution ? ScalableBufferManager.heightScaleFactor : 1) * pixelHeight); } }
        public bool allowDynamicResolution { get; set; }
        public bool orthographic { get; set; }
        public float fieldOfView { get; set; }
        public float nearClipPlane { get; set; }
        public float farClipPlane { get; set; }
        public int cullingMask { get; set; }
        public CameraClearFlags clearFlags { get; set; }
        public Color backgroundColor { get; set; }
        public bool allowHDR { get; set; }
        public bool allowMSAA { get; set; }
        public CameraType cameraType { get; set; }
        public bool stereoEnabled { get { return StandIns.Eyes.IsWorn && cameraType == CameraType.Game; } }
        public Matrix4x4 worldToCameraMatrix
        {
            get { return view ?? Matrix4x4.Scale(new Vector3(1, 1, -1)) * transform.worldToLocalMatrix; }
            set { view = value; }
        }
        public Matrix4x4 projectionMatrix { get { return projection; } set { projection = value; } }
        public Matrix4x4 GetStereoViewMatrix(StereoscopicEye eye) { return StandIns.Eyes.View(this, (int)eye); }
        public Matrix4x4 GetStereoProjectionMatrix(StereoscopicEye eye) { return StandIns.Eyes.Projection(this, (int)eye); }
        public void AddCommandBuffer(Rendering.CameraEvent evt, Rendering.CommandBuffer buffer) { Buffers.Add(buffer); }
        public void RemoveCommandBuffer(Rendering.CameraEvent evt, Rendering.CommandBuffer buffer) 
        {
            while (Buffers.Remove(buffer)) { }
        }
        public void Render()
        {
            if (StandIns.Pipelines.Render != null)
            {
                StandIns.Pipelines.Render(this);
                return;
            }
            bool twice = stereoEnabled && StandIns.Eyes.IsMultiPass;
            for (int pass = 0; pass < (twice ? 2 : 1); pass++)
                RenderPass();
        }

        private void RenderPass()
        {
            if (onPreCull != null)
                onPreCull(this);
            if (onPreRender != null)
                onPreRender(this);
            bool instanced = stereoEnabled && StandIns.Eyes.IsInstanced;
            Graphics.InstanceMultiplier = instanced ? 2u : 1;
            for (int i = 0; i < Buffers.Count; i++)
                Graphics.ExecuteCommandBuffer(Buffers[i]);
            Graphics.InstanceMultiplier = 1;
            if (StandIns.Recorder.IsOn)
                StandIns.Recorder.Note("submit " + name);
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
        internal readonly List<string> Shapes = new List<string>();

        public Bounds bounds { get; set; }
        public int blendShapeCount { get { return Shapes.Count; } }
        public string GetBlendShapeName(int shapeIndex) { return Shapes[shapeIndex]; }
        public void AddBlendShapeFrame(
            string shapeName, float frameWeight, Vector3[] deltaVertices, Vector3[] deltaNormals, Vector3[] deltaTangents)
        {
            Shapes.Add(shapeName);
        }
    }

    public sealed class MeshFilter : Component { public Mesh sharedMesh { get; set; } }
    public class Renderer : Component { public Material sharedMaterial { get; set; } public bool enabled { get; set; } }
    public sealed class MeshRenderer : Renderer { }

    public class SkinnedMeshRenderer : Renderer
    {
        private readonly Dictionary<int, float> weights = new Dictionary<int, float>();

        public Mesh sharedMesh { get; set; }
        public float GetBlendShapeWeight(int index)
        {
            float weight;
            return weights.TryGetValue(index, out weight) ? weight : 0;
        }
        public void SetBlendShapeWeight(int index, float value) { weights[index] = value; }
    }
}
