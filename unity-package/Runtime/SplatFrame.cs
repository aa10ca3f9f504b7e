using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// All avatars' splats together: the dispatches from posed texels to the splats that one or two eyes see, back to front,
    /// in the order of python/mua/player/splats.py. One sort serves avatars that stand among each other, and both eyes; those
    /// outside every eye's view are neither projected nor sorted.
    /// </summary>
    internal sealed class SplatFrame : IDisposable
    {
        private const int ArgumentWords = 5;
        private const int SplatWords = 8;
        private const long MostSplats = (1 << 24) - 1; // distinct indices of the sort's elements, less the one that means none

        private readonly SplatProject splatProject;
        private readonly SplatSort splatSort;
        private readonly AvatarFrame[] avatars;
        private readonly bool[] seen; // by the last Project
        private readonly int shown;
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
            seen = new bool[avatars.Count];
            this.shown = shown;
            long placed = 0;
            for (int i = 0; i < avatars.Count; i++)
            {
                this.avatars[i] = avatars[i];
                placed += Even(avatars[i].Avatar.SplatCounts[0]);
                Capacity = i < shown ? (int)Math.Min(placed, MostSplats) : Capacity;
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
        }

        /// <summary>Splats of the finest levels of the avatars that are drawn.</summary>
        public int Capacity { get; }

        /// <summary>
        /// N, of the avatars that are drawn and that the last Project found in view, and one more where one has an odd number.
        /// </summary>
        public int SplatCount { get; private set; }

        /// <summary>Vertices by which the draw makes a splat, 3 or 6, for the eyes of the last Project.</summary>
        public int Corners { get; private set; } = 6;

        /// <summary>[N, 8] words, as pack_splats of python/mua/kernels/splat_project.py lays them out.</summary>
        public GraphicsBuffer Splats { get; private set; }

        /// <summary>[N] depth keys of 16 bits.</summary>
        public GraphicsBuffer Keys { get; private set; }

        /// <summary>[5] arguments of the draw, and how many splats are visible.</summary>
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
            Place(out Vector3 low, out Vector3 high);
            commands.BeginSample(AvatarStages.Project);
            for (int i = 0; i < avatars.Length; i++)
            {
                if (seen[i])
                {
                    splatProject.Project(commands, this, avatars[i], eyes, low, high);
                }
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

        /// <summary>One avatar in view after the other in Splats, and the box around those that are sorted.</summary>
        private void Place(out Vector3 low, out Vector3 high)
        {
            low = new Vector3(float.MaxValue, float.MaxValue, float.MaxValue);
            high = -low;
            int first = 0;
            double covered = 0;
            SplatCount = 0;
            for (int i = 0; i < avatars.Length; i++)
            {
                AvatarFrame avatar = avatars[i];
                seen[i] = avatar.IsShown && Eyes.Sees(avatar.Low, avatar.High, AvatarEyes.SplatReach);
                if (!seen[i])
                {
                    continue;
                }
                avatar.ShareSplats(Splats, first);
                first += Even(avatar.SplatCount);
                if (i < shown || SplatCount == 0) // what is placed for other views alone has a box of its own
                {
                    low = Vector3.Min(low, avatar.Low);
                    high = Vector3.Max(high, avatar.High);
                }
                if (i < shown)
                {
                    SplatCount = first;
                    covered += Eyes.Covered(avatar.Low, avatar.High);
                }
            }
            Corners = LevelChoice.Corners(covered, SplatCount);
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
            long sorted = (long)SplatSort.Digits * Kernel.Groups(Capacity, SplatSort.Sorted);
            DigitCounts = buffers.Structured("digit_counts", sorted, sizeof(uint));
            DigitTotals = buffers.Structured("digit_totals", SplatSort.Digits, sizeof(uint));
            Arguments = buffers.Copied("arguments", ArgumentWords);
            IndirectArguments = buffers.Arguments("indirect arguments", ArgumentWords);
            halfSorted = buffers.Structured("half_sorted", Capacity, sizeof(uint));
            Order = buffers.Structured("order", Capacity, sizeof(uint));
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
