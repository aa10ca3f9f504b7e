using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// All avatars' splats together: the dispatches from posed splats to those that one or two eyes see, back to front, in
    /// the order of python/mua/player/splats.py. One sort serves avatars that stand among each other, and both eyes.
    /// </summary>
    internal sealed class SplatFrame : IDisposable
    {
        private const int DigitBits = 8, KeyBits = 16;
        private const int ArgumentWords = 8;

        private readonly SplatProject splatProject;
        private readonly SplatSort splatSort;
        private readonly AvatarFrame[] avatars;
        private readonly BufferSet buffers = new BufferSet();
        private readonly GraphicsBuffer[] keys = new GraphicsBuffer[2];
        private readonly GraphicsBuffer[] orders = new GraphicsBuffer[2];

        /// <summary>One avatar at least; InvalidOperationException where the device cannot hold the buffers.</summary>
        public SplatFrame(AvatarResources resources, IReadOnlyList<AvatarFrame> avatars)
            : this(resources, avatars, avatars.Count)
        {
        }

        /// <summary>Only the first `shown` avatars are sorted and drawn; the others are posed for other views.</summary>
        public SplatFrame(AvatarResources resources, IReadOnlyList<AvatarFrame> avatars, int shown)
        {
            splatProject = new SplatProject(resources.SplatProject);
            splatSort = new SplatSort(resources.SplatSort);
            this.avatars = new AvatarFrame[shown];
            int posed = 0;
            for (int i = 0; i < avatars.Count; i++)
            {
                posed += avatars[i].SplatCount;
                if (i < shown)
                {
                    this.avatars[i] = avatars[i];
                    SplatCount = posed;
                }
            }
            try
            {
                CreateBuffers(posed);
            }
            catch
            {
                Dispose();
                throw;
            }
            int first = 0;
            for (int i = 0; i < avatars.Count; i++)
            {
                avatars[i].ShareSplats(Splats, first);
                first += avatars[i].SplatCount;
            }
        }

        /// <summary>N, of all avatars that are drawn.</summary>
        public int SplatCount { get; }

        /// <summary>[N, 16] words.</summary>
        public GraphicsBuffer Splats { get; private set; }

        /// <summary>[E, N, 6].</summary>
        public GraphicsBuffer Ellipses { get; private set; }

        /// <summary>[N, 4] half floats.</summary>
        public GraphicsBuffer Colors { get; private set; }

        /// <summary>[8] of the draw, of the sort's dispatches, and how many splats are visible.</summary>
        public GraphicsBuffer Arguments { get; private set; }

        /// <summary>Arguments once more, for the draw and the dispatches themselves.</summary>
        public GraphicsBuffer IndirectArguments { get; private set; }

        /// <summary>[M] the visible splats, back to front: two passes of the sort end where they began.</summary>
        public GraphicsBuffer Order => orders[0];

        public GraphicsBuffer Flags { get; private set; }

        public GraphicsBuffer GroupCounts { get; private set; }

        public GraphicsBuffer DigitCounts { get; private set; }

        public GraphicsBuffer DigitTotals { get; private set; }

        /// <summary>The eyes of the last Sort.</summary>
        public AvatarEyes Eyes { get; private set; }

        /// <summary>Appends the dispatches from posed splats to Order, for one or two eyes.</summary>
        public void Sort(CommandBuffer commands, AvatarEyes eyes)
        {
            Eyes = eyes;
            Project(commands, eyes);
            commands.BeginSample(AvatarStages.Sort);
            for (int pass = 0; pass < KeyBits / DigitBits; pass++)
            {
                SortDigit(commands, DigitBits * pass, pass % 2);
            }
            commands.EndSample(AvatarStages.Sort);
        }

        public void Dispose()
        {
            buffers.Dispose();
        }

        private void CreateBuffers(int posed)
        {
            Splats = buffers.Structured("splats", 4L * posed, 4 * sizeof(uint));
            Ellipses = buffers.Structured("ellipses", 3L * AvatarEyes.Most * SplatCount, 2 * sizeof(float));
            Colors = buffers.Structured("colors", SplatCount, 2 * sizeof(uint));
            Flags = buffers.Structured("flags", SplatCount, sizeof(uint));
            int groups = Kernel.Groups(SplatCount, SplatProject.Projected);
            GroupCounts = buffers.Structured("group_counts", groups, sizeof(uint));
            Arguments = buffers.Copied("arguments", ArgumentWords);
            IndirectArguments = buffers.Arguments("indirect arguments", ArgumentWords);
            for (int i = 0; i < 2; i++)
            {
                keys[i] = buffers.Structured("keys", SplatCount, sizeof(uint));
                orders[i] = buffers.Structured("order", SplatCount, sizeof(uint));
            }
            long sorted = (long)SplatSort.Digits * Kernel.Groups(SplatCount, SplatSort.Sorted);
            DigitCounts = buffers.Structured("digit_counts", sorted, sizeof(uint));
            DigitTotals = buffers.Structured("digit_totals", SplatSort.Digits, sizeof(uint));
        }

        private void Project(CommandBuffer commands, AvatarEyes eyes)
        {
            Vector3 low = avatars[0].Low, high = avatars[0].High;
            foreach (AvatarFrame avatar in avatars)
            {
                low = Vector3.Min(low, avatar.Low);
                high = Vector3.Max(high, avatar.High);
            }
            commands.BeginSample(AvatarStages.Project);
            splatProject.Project(commands, this, eyes, low, high);
            splatProject.ScanGroups(commands, this, eyes.Instances);
            commands.CopyBuffer(Arguments, IndirectArguments);
            splatProject.Compact(commands, this, orders[0], keys[0]);
            commands.EndSample(AvatarStages.Project);
        }

        /// <summary>One pass of the sort, from buffers `source` of the two pairs to the others.</summary>
        private void SortDigit(CommandBuffer commands, int shift, int source)
        {
            int target = 1 - source;
            splatSort.Count(commands, this, keys[source], shift);
            splatSort.Scan(commands, this);
            splatSort.Scatter(commands, this, keys[source], orders[source], keys[target], orders[target], shift);
        }
    }
}
