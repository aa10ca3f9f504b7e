using System;

namespace Mua.Format
{
    /// <summary>Skeleton, template, texels and surface of a parsed tree, checked as in python/mua/asset/read_rig.py.</summary>
    internal sealed class RigDecoder
    {
        private const int DualNumbers = 8; // of a dual quaternion
        private const long Any = Tensors.Any;

        private readonly Tensors tensors;

        public RigDecoder(Tensors tensors)
        {
            this.tensors = tensors;
        }

        public Skeleton Skeleton(Table tree)
        {
            string[] names = tree.Texts("names");
            int count = names.Length;
            int[] parents = tensors
                .Indices(tree.Child("parents"), "skeleton.parents", -1, count, count).Integers.ToArray();
            for (int joint = 0; joint < count; joint++)
            {
                if (parents[joint] >= joint)
                {
                    throw Refusal.Of(
                        "skeleton.parents", "joint {0} stands before its parent {1}", joint, parents[joint]);
                }
            }
            long root = tree.Number("root");
            if (root >= count)
            {
                throw Refusal.Of("skeleton.root", "{0}, but there are {1} joints", root, count);
            }
            Tensor stored = tensors.Reals(tree.Child("bind_rotations"), "skeleton.bind_rotations", count, 4);
            RequireUnit(stored, "skeleton.bind_rotations");
            double[] rotations = Doubles(stored);
            for (int joint = 0; joint < count; joint++)
            {
                QuaternionD.Load(rotations, joint).Normalized().Store(rotations, joint);
            }
            double[] translations = Doubles(
                tensors.Reals(tree.Child("bind_translations"), "skeleton.bind_translations", count, 3));
            var skeleton = new Skeleton(names, parents, rotations, translations, (int)root);
            RequireInverse(
                skeleton, tensors.Reals(tree.Child("bind_inverse"), "skeleton.bind_inverse", count, 8));
            skeleton.Translated = Translated(tree, "skeleton.translated", skeleton);
            return skeleton;
        }

        /// <summary>Joints beside the root that move in their parents; none in a file that names none.</summary>
        public int[] Translated(Table tree, string path, Skeleton skeleton)
        {
            Table stored = tree.Child("translated");
            if (stored == null)
            {
                return new int[0];
            }
            int[] joints = tensors.Indices(stored, path, 0, skeleton.JointCount, Any).Integers.ToArray();
            RequireBesideRoot(joints, path, skeleton.Root);
            return joints;
        }

        /// <summary>Refuses joints that do not ascend, or the root among them.</summary>
        public static void RequireBesideRoot(int[] joints, string path, int root)
        {
            for (int i = 0; i < joints.Length; i++)
            {
                if ((i > 0 && joints[i] <= joints[i - 1]) || joints[i] == root)
                {
                    throw Refusal.Of(path, "joints must ascend and leave out the root");
                }
            }
        }

        public Template Template(Table tree, int vertices, int joints)
        {
            Tensor uv = tensors.Reals(tree.Child("uv"), "template.uv", Any, 2);
            Tensor faces = tensors.Indices(tree.Child("faces"), "template.faces", 0, vertices, Any, 3);
            Tensor uvFaces = tensors.Indices(
                tree.Child("uv_faces"), "template.uv_faces", 0, uv.Shape[0], faces.Shape[0], 3);
            Tensor weights = tensors.Reals(
                tree.Child("skin_weights"), "template.skin_weights", vertices, Limits.MaxInfluences);
            RequireWeights(weights);
            return new Template
            {
                Uv = uv,
                Faces = faces,
                UvFaces = uvFaces,
                SkinWeights = weights,
                SkinIndices = tensors.Indices(
                    tree.Child("skin_indices"), "template.skin_indices", 0, joints, vertices, Limits.MaxInfluences),
            };
        }

        public Texels Texels(Table tree, byte[] content, Template template)
        {
            long size = tree.Number("size");
            Tensor indices = tensors.Indices(tree.Child("texels"), "texels.texels", 0, size * size, Any);
            ReadOnlySpan<int> texels = indices.Integers;
            for (int i = 1; i < texels.Length; i++)
            {
                if (texels[i] <= texels[i - 1])
                {
                    throw Refusal.Of("texels.texels", "texels must ascend");
                }
            }
            Tensor triangles = tensors.Indices(
                tree.Child("triangles"), "texels.triangles", 0, template.Faces.Shape[0], texels.Length);
            Tensor barycentrics = Barycentrics(tree, template, (int)size, texels, triangles.Integers);
            RequireBarycentrics(barycentrics);
            byte[] oneSided = OneSided(tree.Block("one_sided"), content, texels.Length);
            float length = tree.Real("length");
            if (!(length >= 0 && length <= Limits.Largest))
            {
                throw Refusal.Of("texels.length", "{0:g6}, expected 0 to {1}", length, Limits.Largest);
            }
            return new Texels
            {
                Length = length,
                Levels = Levels(tree.Children("levels"), content, texels, (int)size),
                Size = (int)size,
                Indices = indices,
                Triangles = triangles,
                Barycentrics = barycentrics,
                OneSided = oneSided,
            };
        }

        /// <summary>The blocks of each coarser level, each of which must have a chief among its valid texels.</summary>
        private static BlockLevel[] Levels(Table[] trees, byte[] content, ReadOnlySpan<int> texels, int size)
        {
            var levels = new BlockLevel[trees.Length];
            for (int i = 0; i < levels.Length; i++, size /= 2)
            {
                string path = "texels.levels[" + i + "].blocks";
                Block block = trees[i].Block("blocks");
                levels[i] = new BlockLevel(texels, size, new ReadOnlySpan<byte>(content, block.Offset, block.Count));
                if (block.Count != levels[i].Count)
                {
                    throw new AvatarFormatException(
                        "shape", path, block.Count + " bytes, expected " + levels[i].Count);
                }
                int wrong = levels[i].FindUnsound();
                if (wrong >= 0)
                {
                    throw Refusal.Of(path, "block {0} has not one chief, or a member that is no valid texel", wrong);
                }
                texels = levels[i].Texels;
            }
            return levels;
        }

        /// <summary>A bit for each texel; null where the file has none.</summary>
        private static byte[] OneSided(Block block, byte[] content, int count)
        {
            if (block == null)
            {
                return null;
            }
            int expected = (count + 7) / 8;
            if (block.Count != expected)
            {
                throw new AvatarFormatException(
                    "shape", "texels.one_sided", block.Count + " bytes, expected " + expected);
            }
            return new ArraySegment<byte>(content, block.Offset, block.Count).ToArray();
        }

        /// <summary>[N, 2] as stored, or computed where only those of the listed texels are.</summary>
        private Tensor Barycentrics(
            Table tree, Template template, int size, ReadOnlySpan<int> texels, ReadOnlySpan<int> triangles)
        {
            const string Path = "texels.listed";
            if (tree.Child("listed") == null)
            {
                return tensors.Reals(tree.Child("barycentrics"), "texels.barycentrics", texels.Length, 2);
            }
            ReadOnlySpan<int> listed = tensors.Indices(tree.Child("listed"), Path, 0, texels.Length, Any).Integers;
            for (int i = 1; i < listed.Length; i++)
            {
                if (listed[i] <= listed[i - 1])
                {
                    throw Refusal.Of(Path, "texels must ascend");
                }
            }
            Tensor stored = tensors.Reals(tree.Child("barycentrics"), "texels.barycentrics", listed.Length, 2);
            float[] found = TexelCentres.Barycentrics(template, size, texels, triangles);
            for (int i = 0; i < stored.Count; i++)
            {
                found[2 * listed[i / 2] + i % 2] = stored.Read(i);
            }
            if (Array.Exists(found, float.IsNaN))
            {
                throw Refusal.Of(Path, "a texel is not listed, but its triangle has no area in UV");
            }
            return Tensor.Of(found, texels.Length, 2);
        }

        /// <summary>Null where the file holds none.</summary>
        public Surface Surface(Table tree, byte[] content, Texels texels)
        {
            if (tree == null)
            {
                return null;
            }
            Block block = tree.Block("runs");
            var runs = new ArraySegment<byte>(content, block.Offset, block.Count);
            RequireCodes(runs, texels);
            Tensor strips = tensors.Indices(
                tree.Child("strips"), "surface.strips", Format.Surface.End, 2L * texels.Count, Any);
            return new Surface { Runs = runs, Strips = strips };
        }

        /// <summary>Refuses quaternions that storage alone cannot have brought off unit length.</summary>
        public static void RequireUnit(Tensor quaternions, string path)
        {
            float[] q = quaternions.ToFloats();
            for (int i = 0; i < q.Length; i += 4)
            {
                double length = new QuaternionD(q[i], q[i + 1], q[i + 2], q[i + 3]).Length;
                if (Math.Abs(length - 1) > Limits.UnitBound)
                {
                    throw Refusal.Of(path, "a quaternion of length {0:g4}, expected 1", length);
                }
            }
        }

        private static void RequireInverse(Skeleton skeleton, Tensor stated)
        {
            for (int joint = 0; joint < skeleton.JointCount; joint++)
            {
                double same = 0, opposite = 0; // of all eight numbers
                for (int i = DualNumbers * joint; i < DualNumbers * (joint + 1); i++)
                {
                    same = Math.Max(same, Math.Abs(stated.Read(i) - skeleton.BindInverse[i]));
                    opposite = Math.Max(opposite, Math.Abs(stated.Read(i) + skeleton.BindInverse[i]));
                }
                if (Math.Min(same, opposite) > Limits.BindBound)
                {
                    throw Refusal.Of(
                        "skeleton.bind_inverse", "differs by {0:e1} from the inverse of the bind pose",
                        Math.Min(same, opposite));
                }
            }
        }

        private static void RequireWeights(Tensor weights)
        {
            for (int vertex = 0; vertex < weights.Shape[0]; vertex++)
            {
                float sum = 0, before = float.PositiveInfinity;
                bool negative = false, rising = false;
                for (int i = 0; i < Limits.MaxInfluences; i++)
                {
                    float weight = weights.Read(Limits.MaxInfluences * vertex + i);
                    sum += weight;
                    negative |= weight < 0;
                    rising |= weight > before;
                    before = weight;
                }
                if (negative || Math.Abs(sum - 1) > (float)Limits.WeightBound)
                {
                    throw Refusal.Of(
                        "template.skin_weights", "weights of vertex {0} sum to {1:g4} or one is negative", vertex, sum);
                }
                if (rising)
                {
                    throw Refusal.Of(
                        "template.skin_weights", "weights of vertex {0} do not begin with the largest", vertex);
                }
            }
        }

        private static void RequireBarycentrics(Tensor barycentrics)
        {
            float[] values = barycentrics.ToFloats();
            for (int i = 0; i < values.Length; i += 2)
            {
                float first = values[i], second = values[i + 1], third = 1 - (first + second);
                float least = Math.Min(Math.Min(first, second), third);
                if (least < -Limits.BarycentricSlack)
                {
                    throw Refusal.Of("texels.barycentrics", "{0:g3}, expected 0 to 1", least);
                }
            }
        }

        /// <summary>Refuses another number of codes than of blocks, or a triangle at a corner that is no texel.</summary>
        private static void RequireCodes(ArraySegment<byte> runs, Texels texels)
        {
            var blocks = new BlockWalk(texels);
            long codes = 0, count = 0;
            bool isSound = true;
            foreach (byte run in runs.AsSpan())
            {
                for (int left = run >> Format.Surface.RunShift; left >= 0 && blocks.Next(); left--)
                {
                    isSound &= blocks.Holds(run & Format.Surface.CodeMask);
                    count++;
                }
                codes += (run >> Format.Surface.RunShift) + 1;
            }
            while (blocks.Next())
            {
                count++;
            }
            if (codes != count)
            {
                throw new AvatarFormatException("shape", "surface.runs", codes + " codes, expected " + count);
            }
            if (!isSound)
            {
                throw Refusal.Of("surface.runs", "a triangle has a corner that is no valid texel");
            }
        }

        private static double[] Doubles(Tensor tensor)
        {
            return Array.ConvertAll(tensor.ToFloats(), value => (double)value);
        }
    }
}
