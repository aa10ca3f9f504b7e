using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// All avatars' splats together: the dispatches from posed texels to the splats that one or two eyes see, back to front,
    /// in the order of python/mua/player/splats.py. One sort serves avatars that stand among each other, and both eyes.
    /// </summary>
    internal sealed class SplatFrame : IDisposable
    {
        private const int ArgumentWords = 5;
        private const int SplatWords = 8;
        private const long MostSplats = 1 << 24; // that the elements of the sort can tell apart

        private readonly SplatProject splatProject;
        private readonly SplatSort splatSort;
        private readonly AvatarFrame[] avatars;
        private readonly int shown;
        private readonly int capacity; // splats of the finest levels of those that are shown
        private readonly BufferSet buffers = new BufferSet();
        private GraphicsBuffer halfSorted;

        /// <summary>One avatar at least; InvalidOperationException where the device cannot hold the buffers.</summary>
        public SplatFrame(AvatarResources resources, IReadOnlyList<AvatarFrame> avatars)
            : this(resources, avatars, avatars.Count)
        {
        }

        /// <summary>Only the first `shown` avatars are sorted and drawn; the others are placed for other views.</summary>
        public SplatFrame(AvatarResources resources, IReadOnlyList<AvatarFrame> avatars, int shown)
        {
            splatProject = new SplatProject(resources.SplatProject);
            splatSort = new SplatSort(resources.SplatSort);
            this.avatars = new AvatarFrame[avatars.Count];
            this.shown = shown;
            long placed = 0;
            for (int i = 0; i < avatars.Count; i++)
            {
                this.avatars[i] = avatars[i];
                placed += Even(avatars[i].Avatar.SplatCounts[0]);
                capacity = i < shown ? (int)Math.Min(placed, MostSplats) : capacity;
            }
            try
            {
                CreateBuffers(placed);
            }
            catch
            {
                Dispose();
                throw;
            }
            Place();
        }

        /// <summary>N, of all avatars that are drawn, and one more where an avatar has an odd number; by the last Project.</summary>
        public int SplatCount { get; private set; }

        /// <summary>[N, 8] words, as pack_splats of python/mua/kernels/splat_project.py lays them out.</summary>
        public GraphicsBuffer Splats { get; private set; }

        /// <summary>[N] of 16 bits.</summary>
        public GraphicsBuffer Keys { get; private set; }

        /// <summary>[5] of the draw, and how many splats are visible.</summary>
        public GraphicsBuffer Arguments { get; private set; }

        /// <summary>Arguments once more, for the draw itself.</summary>
        public GraphicsBuffer IndirectArguments { get; private set; }

        /// <summary>[M] the visible splats, back to front.</summary>
        public GraphicsBuffer Order { get; private set; }

        public GraphicsBuffer DigitCounts { get; private set; }

        public GraphicsBuffer DigitTotals { get; private set; }

        /// <summary>The eyes of the last Project.</summary>
        public AvatarEyes Eyes { get; private set; }

        /// <summary>Appends the dispatches from posed texels to splats and keys, for one or two eyes.</summary>
        public void Project(CommandBuffer commands, AvatarEyes eyes)
        {
            Eyes = eyes;
            Place();
            Vector3 low = avatars[0].Low, high = avatars[0].High;
            for (int i = 1; i < shown; i++)
            {
                low = Vector3.Min(low, avatars[i].Low);
                high = Vector3.Max(high, avatars[i].High);
            }
            commands.BeginSample(AvatarStages.Project);
            foreach (AvatarFrame avatar in avatars)
            {
                splatProject.Project(commands, this, avatar, eyes, low, high);
            }
            commands.EndSample(AvatarStages.Project);
        }

        /// <summary>Appends the dispatches from the keys of the last Project to Order.</summary>
        public void Sort(CommandBuffer commands)
        {
            commands.BeginSample(AvatarStages.Sort);
            SortDigit(commands, Keys, halfSorted, 0);
            SortDigit(commands, halfSorted, Order, 1);
            commands.CopyBuffer(Arguments, IndirectArguments);
            commands.EndSample(AvatarStages.Sort);
        }

        public void Dispose()
        {
            buffers.Dispose();
        }

        /// <summary>Gives each avatar room for the splats of the level that it has decoded.</summary>
        private void Place()
        {
            int first = 0;
            for (int i = 0; i < avatars.Length; i++)
            {
                avatars[i].ShareSplats(Splats, first);
                first += Even(avatars[i].SplatCount);
                SplatCount = i < shown ? first : SplatCount;
            }
        }

        private void CreateBuffers(long placed)
        {
            if (placed > MostSplats)
            {
                throw new InvalidOperationException(
                    placed + " splats of all avatars are more than the " + MostSplats + " that can be sorted.");
            }
            Splats = buffers.Structured("splats", SplatWords / 4 * placed, 4 * sizeof(uint));
            Keys = buffers.Structured("keys", placed / 2, sizeof(uint));
            long sorted = (long)SplatSort.Digits * Kernel.Groups(capacity, SplatSort.Sorted);
            DigitCounts = buffers.Structured("digit_counts", sorted, sizeof(uint));
            DigitTotals = buffers.Structured("digit_totals", SplatSort.Digits, sizeof(uint));
            Arguments = buffers.Copied("arguments", ArgumentWords);
            IndirectArguments = buffers.Arguments("indirect arguments", ArgumentWords);
            halfSorted = buffers.Structured("half_sorted", capacity, sizeof(uint));
            Order = buffers.Structured("order", capacity, sizeof(uint));
        }

        /// <summary>One pass of the sort, from the splats' keys to elements, or from those to the order.</summary>
        private void SortDigit(CommandBuffer commands, GraphicsBuffer keys, GraphicsBuffer sorted, int secondPass)
        {
            splatSort.Count(commands, this, keys, secondPass);
            splatSort.Scan(commands, this, secondPass);
            splatSort.Scatter(commands, this, keys, sorted, secondPass, Eyes.Instances);
        }

        /// <summary>An avatar's splats, and one more where they are odd: two keys lie in a word.</summary>
        private static int Even(int splats)
        {
            return splats + splats % 2;
        }
    }
}
