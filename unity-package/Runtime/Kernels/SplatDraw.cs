using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// The draw of sorted splats: Shaders/splat.shader over ComputeShaders/splat_draw.hlsl. A pipeline takes the parts, or
    /// lets Draw append them.
    /// </summary>
    internal sealed class SplatDraw : IDisposable
    {
        public const int VerticesPerSplat = 6;

        private const string File = "the splat shader";

        private static readonly int Order = Shader.PropertyToID("order");
        private static readonly int Ellipses = Shader.PropertyToID("ellipses");
        private static readonly int Colors = Shader.PropertyToID("colors");
        private static readonly int Splats = Shader.PropertyToID("splats");
        private static readonly int ViewProjection = Shader.PropertyToID("view_projection");
        private static readonly int Screen = Shader.PropertyToID("screen");
        private static readonly int SplatCount = Shader.PropertyToID("splat_count");
        private static readonly int EyeCount = Shader.PropertyToID("eye_count");
        private static readonly int VisibleArguments = Shader.PropertyToID("visible_arguments");
        private static readonly int Direct = Shader.PropertyToID("direct");

        /// <summary>InvalidOperationException where the shader is missing or the device cannot run it.</summary>
        public SplatDraw(Shader shader)
        {
            if (shader == null || !shader.isSupported)
            {
                throw new InvalidOperationException(
                    File + " is missing, or " + SystemInfo.graphicsDeviceName + " cannot run it.");
            }
            Material = new Material(shader) { name = "MUA splats", hideFlags = HideFlags.HideAndDontSave };
            Indirect = SystemInfo.supportsIndirectArgumentsBuffer;
        }

        public Material Material { get; private set; }

        public MaterialPropertyBlock Properties { get; } = new MaterialPropertyBlock();

        /// <summary>[4] vertices and instances of the draw, at byte 0.</summary>
        public GraphicsBuffer Arguments { get; private set; }

        /// <summary>Of a direct draw, which covers all splats, the visible ones first.</summary>
        public int VertexCount { get; private set; }

        /// <summary>Of a direct draw; render pipelines multiply it where an indirect one needs AvatarEyes.Instances.</summary>
        public int InstanceCount => 1;

        /// <summary>Whether the device takes counts from Arguments.</summary>
        public bool Indirect { get; }

        /// <summary>Takes the buffers and eyes of what was sorted last.</summary>
        public void Bind(SplatFrame frame)
        {
            Properties.SetBuffer(Order, frame.Order);
            Properties.SetBuffer(Ellipses, frame.Ellipses);
            Properties.SetBuffer(Colors, frame.Colors);
            Properties.SetBuffer(Splats, frame.Splats);
            Properties.SetMatrixArray(ViewProjection, frame.Eyes.DeviceViewProjection);
            Properties.SetVector(Screen, new Vector4(frame.Eyes.Screen[0], frame.Eyes.Screen[1], 0, 0));
            Properties.SetInteger(SplatCount, frame.SplatCount);
            Properties.SetInteger(EyeCount, frame.Eyes.Count);
            Properties.SetBuffer(VisibleArguments, frame.Arguments);
            Properties.SetInteger(Direct, Indirect ? 0 : 1);
            Arguments = frame.Arguments;
            VertexCount = VerticesPerSplat * frame.SplatCount;
        }

        /// <summary>Appends the draw of what Bind took.</summary>
        public void Draw(CommandBuffer commands)
        {
            if (Indirect)
            {
                commands.DrawProceduralIndirect(
                    Matrix4x4.identity, Material, 0, MeshTopology.Triangles, Arguments, 0, Properties);
                return;
            }
            commands.DrawProcedural(
                Matrix4x4.identity, Material, 0, MeshTopology.Triangles, VertexCount, InstanceCount, Properties);
        }

        public void Dispose()
        {
            if (Material != null)
            {
                UnityEngine.Object.DestroyImmediate(Material);
                Material = null;
            }
        }
    }
}
