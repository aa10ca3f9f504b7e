using System;
using Mua.Format;

namespace Mua
{
    /// <summary>
    /// The texels of one level of detail: those of the file, or 2 x 2 of the finer level as one, as python/mua/avatar/coarser.py
    /// makes them. It may be made on any thread.
    /// </summary>
    internal sealed class DetailLevel
    {
        private const int Most = 2; // levels beyond the finest
        private const int MostTaps = 32; // of a wavelet that has coarser levels
        private const double Reach = 6; // texels: what lies farther apart belongs to other surfaces
        private const double Growth = 1.85; // of the standard deviations where one splat stands for four
        private const double Turn = 1; // between quaternions that have a part in a mean rotation
        private const int BlockTexels = 4;
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

        /// <summary>The coarsest level of an avatar, 0 where it has but one.</summary>
        public static int Coarsest(AvatarFile avatar)
        {
            int details = Math.Max(avatar.Geometry.Details.Length, avatar.Appearance.Details.Length);
            return avatar.Wavelet.RecLo.Length > MostTaps ? 0 : Math.Min(Most, avatar.Wavelet.Levels - details);
        }

        /// <summary>All levels of an avatar, the finest first.</summary>
        public static DetailLevel[] All(AvatarFile avatar)
        {
            var levels = new DetailLevel[Coarsest(avatar) + 1];
            levels[0] = Finest(avatar);
            for (int i = 1; i < levels.Length; i++)
            {
                levels[i] = levels[i - 1].Coarser();
            }
            return levels;
        }

        /// <summary>The side of a texel of the finest level on the surface, metres: of all of the mean mesh in equal parts.</summary>
        public static double TexelLength(AvatarFile avatar)
        {
            return TexelLength(avatar, avatar.Texels.Count);
        }

        private static double TexelLength(AvatarFile avatar, int count)
        {
            double area = 0;
            ReadOnlySpan<int> corners = avatar.Template.Faces.Integers;
            for (int i = 0; i < corners.Length; i += 3)
            {
                Vector3D a = Vertex(avatar, corners[i]);
                Vector3D across = Vector3D.Cross(Vertex(avatar, corners[i + 1]) - a, Vertex(avatar, corners[i + 2]) - a);
                area += Math.Sqrt(SquaredLength(across)) / 2;
            }
            return count == 0 ? 0 : Math.Sqrt(area / count);
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

        private DetailLevel Coarser()
        {
            int[] blocks = Blocks(out int[] numbers);
            double reach = Reach * TexelLength(avatar, Count);
            var level = new DetailLevel(avatar, Number + 1, Size / 2, numbers.Length)
            {
                Geometry = new float[avatar.Geometry.Channels * numbers.Length],
                Appearance = new float[avatar.Appearance.Channels * numbers.Length],
            };
            numbers.CopyTo(level.Texels, 0);
            for (int block = 0; block < numbers.Length; block++)
            {
                var members = new Span<int>(blocks, BlockTexels * block, BlockTexels);
                int chief = Chief(members, reach);
                KeepNear(members, chief, reach);
                level.Triangles[block] = Triangles[chief];
                level.Barycentrics[2 * block] = Barycentrics[2 * chief];
                level.Barycentrics[2 * block + 1] = Barycentrics[2 * chief + 1];
                level.points[block] = points[chief];
                level.Merge(this, block, members, chief);
            }
            return level;
        }

        /// <summary>
        /// The texels [B, 4] of each block that holds any, -1 for one that is not valid, and the blocks as texels of half the
        /// size, ascending.
        /// </summary>
        private int[] Blocks(out int[] numbers)
        {
            int side = Size / 2, count = 0;
            var places = new int[side * side]; // one more than where a block stands
            foreach (int texel in Texels)
            {
                places[texel / Size / 2 * side + texel % Size / 2] = 1;
            }
            for (int i = 0; i < places.Length; i++)
            {
                count += places[i];
                places[i] *= count;
            }
            var blocks = new int[BlockTexels * count];
            numbers = new int[count];
            Array.Fill(blocks, -1);
            for (int i = 0; i < Count; i++)
            {
                int row = Texels[i] / Size, column = Texels[i] % Size, number = row / 2 * side + column / 2;
                blocks[BlockTexels * (places[number] - 1) + row % 2 * 2 + column % 2] = i;
                numbers[places[number] - 1] = number;
            }
            return blocks;
        }

        /// <summary>The texel that has most of a block within reach, the first of equals.</summary>
        private int Chief(ReadOnlySpan<int> members, double reach)
        {
            int chief = -1, most = 0;
            foreach (int member in members)
            {
                int near = 0;
                foreach (int other in members)
                {
                    near += member >= 0 && other >= 0 && IsNear(member, other, reach) ? 1 : 0;
                }
                if (near > most)
                {
                    chief = member;
                    most = near;
                }
            }
            return chief;
        }

        private void KeepNear(Span<int> members, int chief, double reach)
        {
            for (int i = 0; i < members.Length; i++)
            {
                if (members[i] >= 0 && !IsNear(members[i], chief, reach))
                {
                    members[i] = -1;
                }
            }
        }

        private bool IsNear(int one, int other, double reach)
        {
            return Math.Sqrt(SquaredLength(Place(one) - Place(other))) <= reach;
        }

        /// <summary>Sets a texel of this level, its place but for, to what members of the finer one have.</summary>
        private void Merge(DetailLevel finer, int texel, ReadOnlySpan<int> members, int chief)
        {
            var aside = new Vector3D();
            int count = 0;
            OneSided[texel] = true;
            foreach (int member in members)
            {
                if (member >= 0)
                {
                    count++;
                    OneSided[texel] &= finer.OneSided[member];
                    aside += finer.Place(member) - finer.points[chief];
                }
            }
            Span<double> offset = stackalloc double[Rotation];
            aside.Store(offset, 0);
            double growth = Math.Log(Growth) * Math.Log(count) / Math.Log(2) / 2;
            for (int channel = 0; channel < avatar.Geometry.Channels; channel++)
            {
                bool turns = channel >= Rotation && channel < Scale;
                double value = channel < Rotation
                    ? offset[channel] / count
                    : finer.Mean(finer.Geometry, channel, members, turns ? chief : -1);
                value += channel >= Scale && channel < Opacity ? growth : 0;
                Geometry[channel * Count + texel] = (float)value;
            }
            for (int channel = 0; channel < avatar.Appearance.Channels; channel++)
            {
                Appearance[channel * Count + texel] = (float)finer.Mean(finer.Appearance, channel, members, -1);
            }
        }

        /// <summary>The mean of a channel over members, or over those that are turned nearly as `chief` where there is one.</summary>
        private double Mean(float[] offsets, int channel, ReadOnlySpan<int> members, int chief)
        {
            double sum = 0;
            int count = 0;
            foreach (int member in members)
            {
                if (member >= 0 && (chief < 0 || IsTurnedAlike(member, chief)))
                {
                    sum += offsets[channel * Count + member];
                    count++;
                }
            }
            return sum / count;
        }

        private bool IsTurnedAlike(int one, int other)
        {
            double squares = 0;
            for (int channel = Rotation; channel < Scale; channel++)
            {
                double apart = (double)Geometry[channel * Count + one] - Geometry[channel * Count + other];
                squares += apart * apart;
            }
            return Math.Sqrt(squares) <= Turn;
        }

        /// <summary>Where a texel lies on the mean mesh, moved by its static offset, metres.</summary>
        private Vector3D Place(int texel)
        {
            return points[texel] + new Vector3D(Geometry[texel], Geometry[Count + texel], Geometry[2 * Count + texel]);
        }

        private Vector3D Point(int texel)
        {
            double first = Barycentrics[2 * texel], second = Barycentrics[2 * texel + 1];
            int corner = 3 * Triangles[texel];
            ReadOnlySpan<int> faces = avatar.Template.Faces.Integers;
            return first * Vertex(avatar, faces[corner]) + second * Vertex(avatar, faces[corner + 1]) +
                   Math.Max(1 - first - second, 0) * Vertex(avatar, faces[corner + 2]);
        }

        private static Vector3D Vertex(AvatarFile avatar, int vertex)
        {
            Tensor mean = avatar.Coarse.Mean;
            return new Vector3D(mean.Read(3 * vertex), mean.Read(3 * vertex + 1), mean.Read(3 * vertex + 2));
        }

        private static double SquaredLength(in Vector3D v)
        {
            return v.X * v.X + v.Y * v.Y + v.Z * v.Z;
        }
    }
}
