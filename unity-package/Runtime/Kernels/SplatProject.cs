using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Posed texels to splats on the screen: ComputeShaders/splat_project.compute.</summary>
    internal sealed class SplatProject
    {
        private const string File = "splat_project.compute";
        private const int Projected = 256; // texels of a group

        private static readonly int Mesh = Shader.PropertyToID("mesh");
        private static readonly int Faces = Shader.PropertyToID("faces");
        private static readonly int Texels = Shader.PropertyToID("texels");
        private static readonly int TexelChannels = Shader.PropertyToID("texel_channels");
        private static readonly int VertexDq = Shader.PropertyToID("vertex_dq");
        private static readonly int Splats = Shader.PropertyToID("splats");
        private static readonly int Keys = Shader.PropertyToID("keys");
        private static readonly int View = Shader.PropertyToID("view");
        private static readonly int Projection = Shader.PropertyToID("projection");
        private static readonly int BoundsLow = Shader.PropertyToID("bounds_low");
        private static readonly int BoundsHigh = Shader.PropertyToID("bounds_high");
        private static readonly int Screen = Shader.PropertyToID("screen");
        private static readonly int Near = Shader.PropertyToID("near");
        private static readonly int Eyes = Shader.PropertyToID("eyes");
        private static readonly int TexelCount = Shader.PropertyToID("texel_count");
        private static readonly int FirstSplat = Shader.PropertyToID("first_splat");

        private readonly Kernel project;

        public SplatProject(ComputeShader shader)
        {
            project = new Kernel(shader, File, "SplatProject");
        }

        /// <summary>An avatar's splats and depth keys, as the eyes see them; the box is keyed in depth, metres.</summary>
        public void Project(
            CommandBuffer commands, SplatFrame frame, AvatarFrame avatar, AvatarEyes eyes, Vector3 low, Vector3 high)
        {
            project.Set(commands, Mesh, avatar.Mesh);
            project.Set(commands, Faces, avatar.Avatar.Faces);
            project.Set(commands, Texels, avatar.Level.Texels);
            project.Set(commands, TexelChannels, avatar.TexelChannels);
            project.Set(commands, VertexDq, avatar.VertexDq);
            project.Set(commands, Splats, frame.Splats);
            project.Set(commands, Keys, frame.Keys);
            project.Set(commands, View, eyes.View);
            project.Set(commands, Projection, eyes.Projection);
            project.Set(commands, BoundsLow, new Vector4(low.x, low.y, low.z, avatar.Size));
            project.Set(commands, BoundsHigh, new Vector4(high.x, high.y, high.z, 1));
            project.Set(commands, Screen, eyes.Screen);
            project.Set(commands, Near, eyes.Near);
            project.Set(commands, Eyes, eyes.Count);
            project.Set(commands, TexelCount, avatar.SplatCount);
            project.Set(commands, FirstSplat, avatar.FirstSplat);
            project.Dispatch(commands, Kernel.Groups(avatar.SplatCount, Projected), 1, 1);
        }
    }
}
