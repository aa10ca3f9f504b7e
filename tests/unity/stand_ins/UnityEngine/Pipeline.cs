// Stand-in. Source: Unity 6000.0 reference source, RenderPipelineManager, ScriptableRenderContext,
// RenderTextureDescriptor, ScalableBufferManager, GraphicsSettings.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public struct RenderTextureDescriptor
    {
        public int width { get; set; }
        public int height { get; set; }
        public Rendering.TextureDimension dimension { get; set; }
        public bool useDynamicScale { get; set; }
    }

    public static class ScalableBufferManager
    {
        static ScalableBufferManager() { widthScaleFactor = heightScaleFactor = 1; }

        public static float widthScaleFactor { get; private set; }
        public static float heightScaleFactor { get; private set; }
        public static void ResizeBuffers(float widthScale, float heightScale)
        {
            widthScaleFactor = widthScale;
            heightScaleFactor = heightScale;
        }
    }
}

namespace UnityEngine.Rendering
{
    public enum TextureDimension { Unknown = -1, None, Any, Tex2D, Tex3D, Cube, Tex2DArray, CubeArray }

    public interface IRenderPipelineGraphicsSettings { int version { get; } }

    public struct ScriptableRenderContext
    {
        public void ExecuteCommandBuffer(CommandBuffer commandBuffer) { Graphics.ExecuteCommandBuffer(commandBuffer); }
    }

    public static class RenderPipelineManager
    {
        public static event Action<ScriptableRenderContext, Camera> beginCameraRendering;
        public static event Action<ScriptableRenderContext, Camera> endCameraRendering;

        internal static void Begin(Camera camera)
        {
            if (beginCameraRendering != null)
                beginCameraRendering(new ScriptableRenderContext(), camera);
        }

        internal static void End(Camera camera)
        {
            if (endCameraRendering != null)
                endCameraRendering(new ScriptableRenderContext(), camera);
        }
    }

    public static partial class GraphicsSettings
    {
        internal static readonly Dictionary<Type, object> Settings = new Dictionary<Type, object>();

        public static bool TryGetRenderPipelineSettings<T>(out T settings) where T : class, IRenderPipelineGraphicsSettings
        {
            object held;
            settings = Settings.TryGetValue(typeof(T), out held) ? (T)held : null;
            return settings != null;
        }
    }
}

namespace StandIns
{
    using UnityEngine;
    using UnityEngine.Rendering;

    /// <summary>What a stand-in of a render pipeline needs of the engine. Not Unity's API.</summary>
    public static class Pipelines
    {
        /// <summary>Draws a camera in place of the built-in pipeline.</summary>
        public static Action<Camera> Render;

        public static void Use(RenderPipelineAsset asset) { GraphicsSettings.currentRenderPipeline = asset; }
        public static void Set(IRenderPipelineGraphicsSettings settings) { GraphicsSettings.Settings[settings.GetType()] = settings; }
        public static void Begin(Camera camera) { RenderPipelineManager.Begin(camera); }
        public static void End(Camera camera) { RenderPipelineManager.End(camera); }
        public static void Note(CommandBuffer commands, string text) { commands.Note(text); }
    }

    /// <summary>How both eyes are drawn. Not Unity's API.</summary>
    public enum StereoMode { MultiPass, SinglePassInstanced, SinglePassMultiview }

    /// <summary>Two eyes that all game cameras are drawn for. Not Unity's API.</summary>
    public static class Eyes
    {
        private const float HalfDistance = 0.0315f;
        private static readonly Matrix4x4?[] Views = new Matrix4x4?[2], Projections = new Matrix4x4?[2];

        private static RenderTextureDescriptor target = new RenderTextureDescriptor { width = 1680, height = 1760 };
        private static StereoMode mode;

        public static bool IsWorn { get; private set; }

        public static bool IsMultiPass { get { return IsWorn && mode == StereoMode.MultiPass; } }
        public static bool IsInstanced { get { return IsWorn && mode == StereoMode.SinglePassInstanced; } }

        /// <summary>Share of the eyes' textures along a side that is drawn into.</summary>
        public static float Scale = 1;

        /// <summary>Puts on a headset; another, whose display does not run, is there too.</summary>
        public static void Wear(StereoMode stereo)
        {
            SubsystemManager.All.Insert(0, new UnityEngine.XR.XRDisplaySubsystem());
            Headset.Connect();
            IsWorn = true;
            mode = stereo;
            Machine.Multiview(mode == StereoMode.SinglePassMultiview);
        }

        public static int Width { get { return target.width; } }
        public static int Height { get { return target.height; } }

        public static void Resolution(int width, int height)
        {
            target.width = width;
            target.height = height;
        }

        internal static int Passes(UnityEngine.XR.XRDisplaySubsystem display)
        {
            return !display.running || !IsWorn ? 0 : mode == StereoMode.MultiPass ? 2 : 1;
        }

        internal static RenderTextureDescriptor Target
        {
            get
            {
                target.dimension = IsMultiPass ? TextureDimension.Tex2D : TextureDimension.Tex2DArray;
                return target;
            }
        }

        /// <summary>Where an eye is and what it sees; half the eyes' distance from the camera, as that does, where nobody says.</summary>
        public static void Look(int eye, Matrix4x4 view, Matrix4x4 projection)
        {
            Views[eye] = view;
            Projections[eye] = projection;
        }

        public static Matrix4x4 View(Camera camera, int eye)
        {
            return Views[eye] ?? Matrix4x4.Translate(new Vector3(eye == 0 ? HalfDistance : -HalfDistance, 0, 0)) * camera.worldToCameraMatrix;
        }

        public static Matrix4x4 Projection(Camera camera, int eye) { return Projections[eye] ?? camera.projectionMatrix; }
    }
}
