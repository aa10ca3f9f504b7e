using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>Splats to screen and their compaction: ComputeShaders/splat_project.compute.</summary>
    internal sealed class SplatProject
    {
        /// <summary>Splats of a group of SplatProject and SplatCompact.</summary>
        public const int Projected = 256;

        private const string File = "splat_project.compute";

        private static readonly int Splats = Shader.PropertyToID("splats");
        private static readonly int Ellipses = Shader.PropertyToID("ellipses");
        private static readonly int Colors = Shader.PropertyToID("colors");
        private static readonly int Flags = Shader.PropertyToID("flags");
        private static readonly int GroupCounts = Shader.PropertyToID("group_counts");
        private static readonly int Arguments = Shader.PropertyToID("arguments");
        private static readonly int Visible = Shader.PropertyToID("visible");
        private static readonly int Keys = Shader.PropertyToID("keys");
        private static readonly int View = Shader.PropertyToID("view");
        private static readonly int Projection = Shader.PropertyToID("projection");
        private static readonly int Camera = Shader.PropertyToID("camera");
        private static readonly int BoundsLow = Shader.PropertyToID("bounds_low");
        private static readonly int BoundsHigh = Shader.PropertyToID("bounds_high");
        private static readonly int Screen = Shader.PropertyToID("screen");
        private static readonly int Near = Shader.PropertyToID("near");
        private static readonly int Eyes = Shader.PropertyToID("eyes");
        private static readonly int SplatCount = Shader.PropertyToID("splat_count");
        private static readonly int Instances = Shader.PropertyToID("instances");

        private readonly Kernel project;
        private readonly Kernel scanCounts;
        private readonly Kernel compact;

        public SplatProject(ComputeShader shader)
        {
            project = new Kernel(shader, File, "SplatProject");
            scanCounts = new Kernel(shader, File, "ScanCounts");
            compact = new Kernel(shader, File, "SplatCompact");
        }

        /// <summary>Ellipses, colours and depth keys of what the eyes may see; the box is keyed in depth, metres.</summary>
        public void Project(CommandBuffer commands, SplatFrame frame, AvatarEyes eyes, Vector3 low, Vector3 high)
        {
            project.Set(commands, Splats, frame.Splats);
            project.Set(commands, Ellipses, frame.Ellipses);
            project.Set(commands, Colors, frame.Colors);
            project.Set(commands, Flags, frame.Flags);
            project.Set(commands, GroupCounts, frame.GroupCounts);
            project.Set(commands, View, eyes.View);
            project.Set(commands, Projection, eyes.Projection);
            project.Set(commands, Camera, eyes.Middle);
            project.Set(commands, BoundsLow, new Vector4(low.x, low.y, low.z, 1));
            project.Set(commands, BoundsHigh, new Vector4(high.x, high.y, high.z, 1));
            project.Set(commands, Screen, eyes.Screen);
            project.Set(commands, Near, eyes.Near);
            project.Set(commands, Eyes, eyes.Count);
            project.Set(commands, SplatCount, frame.SplatCount);
            project.Dispatch(commands, Kernel.Groups(frame.SplatCount, Projected), 1, 1);
        }

        /// <summary>Counts of groups to places, and the arguments of the sort and of a draw of `instances`.</summary>
        public void ScanGroups(CommandBuffer commands, SplatFrame frame, int instances)
        {
            scanCounts.Set(commands, GroupCounts, frame.GroupCounts);
            scanCounts.Set(commands, Arguments, frame.Arguments);
            scanCounts.Set(commands, SplatCount, frame.SplatCount);
            scanCounts.Set(commands, Instances, instances);
            scanCounts.Dispatch(commands, 1, 1, 1);
        }

        /// <summary>The visible splats and their keys, side by side.</summary>
        public void Compact(CommandBuffer commands, SplatFrame frame, GraphicsBuffer visible, GraphicsBuffer keys)
        {
            compact.Set(commands, Flags, frame.Flags);
            compact.Set(commands, GroupCounts, frame.GroupCounts);
            compact.Set(commands, Visible, visible);
            compact.Set(commands, Keys, keys);
            compact.Set(commands, SplatCount, frame.SplatCount);
            compact.Dispatch(commands, Kernel.Groups(frame.SplatCount, Projected), 1, 1);
        }
    }
}
