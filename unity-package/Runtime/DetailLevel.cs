using System;
using Mua.Format;

namespace Mua
{
    /// <summary>
    /// The texels of one level of detail: those of the file, or every 2 x 2 texels of the finer level as one; the file
    /// says which. It may be made on any thread. Reference: python/mua/avatar/coarser.py.
    /// </summary>
    internal sealed class DetailLevel
    {
        private const int Rotation = 3, Scale = 7, Opacity = 10; // first channels

        private readonly AvatarFile avatar;
        private readonly Vector3D[] points; // [N] of the mean mesh, metres

        private DetailLevel(AvatarFile avatar, int number, int size, int count)
        {
            this.avatar = avatar;
            Number = number;
            Size = size;
            Texels = new int[count];
            Triangles = new int[count];
            Barycentrics = new float[2 * count];
            OneSided = new bool[count];
            points = new Vector3D[count];
        }

        /// <summary>0 is the finest.</summary>
        public int Number { get; }

        /// <summary>Texels along a side of the texture.</summary>
        public int Size { get; }

        /// <summary>N.</summary>
        public int Count => Texels.Length;

        /// <summary>[N] row * size + column, ascending.</summary>
        public int[] Texels { get; }

        /// <summary>[N] into the faces.</summary>
        public int[] Triangles { get; }

        /// <summary>[N, 2] the first two.</summary>
        public float[] Barycentrics { get; }

        /// <summary>[N] whether a texel is not drawn from behind.</summary>
        public bool[] OneSided { get; }

        /// <summary>[C, N] static offset of geometry.</summary>
        public float[] Geometry { get; private set; }

        /// <summary>[C, N] static offset of appearance.</summary>
        public float[] Appearance { get; private set; }

        /// <summary>All levels of an avatar, the finest first.</summary>
        public static DetailLevel[] All(AvatarFile avatar)
        {
            var levels = new DetailLevel[avatar.Texels.Levels.Length + 1];
            levels[0] = Finest(avatar);
            for (int i = 1; i < levels.Length; i++)
            {
                levels[i] = levels[i - 1].Coarser(avatar.Texels.Levels[i - 1]);
            }
            return levels;
        }

        private static DetailLevel Finest(AvatarFile avatar)
        {
            Texels texels = avatar.Texels;
            var level = new DetailLevel(avatar, 0, texels.Size, texels.Count)
            {
                Geometry = avatar.Geometry.StaticOffset.ToFloats(),
                Appearance = avatar.Appearance.StaticOffset.ToFloats(),
            };
            texels.Indices.Integers.CopyTo(level.Texels);
            texels.Triangles.Integers.CopyTo(level.Triangles);
            texels.Barycentrics.ToFloats().CopyTo(level.Barycentrics, 0);
            for (int i = 0; i < level.Count; i++)
            {
                level.points[i] = level.Point(i);
                level.OneSided[i] = texels.IsOneSided(i);
            }
            return level;
        }

        private DetailLevel Coarser(BlockLevel blocks)
        {
            var level = new DetailLevel(avatar, Number + 1, Size / 2, blocks.Count)
            {
                Geometry = new float[avatar.Geometry.Channels * blocks.Count],
                Appearance = new float[avatar.Appearance.Channels * blocks.Count],
            };
            blocks.Texels.CopyTo(level.Texels, 0);
            var members = new int[BlockLevel.Four];
            var turned = new int[BlockLevel.Four];
            for (int block = 0; block < blocks.Count; block++)
            {
                int count = Gather(blocks, block, BlockLevel.Member, members), chief = -1;
                int alike = Gather(blocks, block, BlockLevel.Turned, turned);
                for (int corner = 0; corner < BlockLevel.Four; corner++)
                {
                    chief = blocks.Kind(block, corner) == BlockLevel.Chief ? blocks.Finer(block, corner) : chief;
                }
                level.Triangles[block] = Triangles[chief];
                level.Barycentrics[2 * block] = Barycentrics[2 * chief];
                level.Barycentrics[2 * block + 1] = Barycentrics[2 * chief + 1];
                level.points[block] = points[chief];
                level.Merge(this, block, new Span<int>(members, 0, count), new Span<int>(turned, 0, alike));
            }
            return level;
        }

        /// <summary>How many texels of a block are at least of this kind; `found` begins with them.</summary>
        private static int Gather(BlockLevel blocks, int block, int kind, int[] found)
        {
            int count = 0;
            for (int corner = 0; corner < BlockLevel.Four; corner++)
            {
                if (blocks.Kind(block, corner) >= kind)
                {
                    found[count++] = blocks.Finer(block, corner);
                }
            }
            return count;
        }

        /// <summary>Sets a texel of this level, its place but for, to what members of the finer one have.</summary>
        private void Merge(DetailLevel finer, int texel, ReadOnlySpan<int> members, ReadOnlySpan<int> turned)
        {
            var aside = new Vector3D();
            OneSided[texel] = true;
            foreach (int member in members)
            {
                OneSided[texel] &= finer.OneSided[member];
                aside += finer.Place(member) - points[texel];
            }
            Span<double> offset = stackalloc double[Rotation];
            aside.Store(offset, 0);
            double growth = Math.Log(BlockLevel.Growth) * Math.Log(members.Length) / Math.Log(2) / 2;
            for (int channel = 0; channel < avatar.Geometry.Channels; channel++)
            {
                bool turns = channel >= Rotation && channel < Scale;
                double value = channel < Rotation
                    ? offset[channel] / members.Length
                    : finer.Mean(finer.Geometry, channel, turns ? turned : members);
                value += channel >= Scale && channel < Opacity ? growth : 0;
                Geometry[channel * Count + texel] = (float)value;
            }
            for (int channel = 0; channel < avatar.Appearance.Channels; channel++)
            {
                Appearance[channel * Count + texel] = (float)finer.Mean(finer.Appearance, channel, members);
            }
        }

        private double Mean(float[] offsets, int channel, ReadOnlySpan<int> members)
        {
            double sum = 0;
            foreach (int member in members)
            {
                sum += offsets[channel * Count + member];
            }
            return sum / members.Length;
        }

        /// <summary>Where a texel lies on the mean mesh, moved by its static offset, metres.</summary>
        private Vector3D Place(int texel)
        {
            return points[texel] + new Vector3D(Geometry[texel], Geometry[Count + texel], Geometry[2 * Count + texel]);
        }

        private Vector3D Point(int texel)
        {
            float first = Barycentrics[2 * texel], second = Barycentrics[2 * texel + 1];
            float third = (float)(1 - (float)(first + second)); // rounded as Python has it
            int corner = 3 * Triangles[texel];
            ReadOnlySpan<int> faces = avatar.Template.Faces.Integers;
            return first * Vertex(avatar, faces[corner]) + second * Vertex(avatar, faces[corner + 1]) +
                   Math.Max(third, 0) * Vertex(avatar, faces[corner + 2]);
        }

        private static Vector3D Vertex(AvatarFile avatar, int vertex)
        {
            Tensor mean = avatar.Coarse.Mean;
            return new Vector3D(mean.Read(3 * vertex), mean.Read(3 * vertex + 1), mean.Read(3 * vertex + 2));
        }
    }
}
