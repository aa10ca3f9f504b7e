using System;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// The draw of sorted splats: Shaders/splat.shader over ComputeShaders/splat_draw.hlsl.
    /// </summary>
    internal sealed class SplatDraw : IDisposable
    {
        private const string File = "the splat shader";
        private const int IndirectPass = 0, DirectPass = 1;

        private static readonly int Order = Shader.PropertyToID("order");
        private static readonly int Splats = Shader.PropertyToID("splats");
        private static readonly int ViewProjection = Shader.PropertyToID("view_projection");
        private static readonly int Screen = Shader.PropertyToID("screen");
        private static readonly int Corners = Shader.PropertyToID("corners");
        private static readonly int EyeCount = Shader.PropertyToID("eye_count");
        private static readonly int VisibleArguments = Shader.PropertyToID("visible_arguments");

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

        /// <summary>Whether the device takes counts from Arguments.</summary>
        public bool Indirect { get; }

        /// <summary>The draw of what was sorted last; a direct one covers all splats, the visible ones first.</summary>
        public AvatarDraw Bind(SplatFrame frame)
        {
            Properties.SetBuffer(Order, frame.Order);
            Properties.SetBuffer(Splats, frame.Splats);
            Properties.SetMatrixArray(ViewProjection, frame.Eyes.DeviceViewProjection);
            Properties.SetVector(Screen, new Vector4(frame.Eyes.Screen[0], frame.Eyes.Screen[1], 0, 0));
            Properties.SetInteger(EyeCount, frame.Eyes.Count);
            Properties.SetInteger(Corners, frame.Corners);
            Properties.SetBuffer(VisibleArguments, frame.Arguments);
            return Indirect
                ? AvatarDraw.Indirect(Material, IndirectPass, Properties, frame.IndirectArguments)
                : AvatarDraw.Direct(Material, DirectPass, Properties, frame.Corners * frame.SplatCount);
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
