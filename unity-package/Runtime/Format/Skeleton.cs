using System;
using System.Collections.Generic;

namespace Mua.Format
{
    /// <summary>Joints in parent-before-child order; metres, Y up, right-handed; quaternions wxyz in flat arrays.</summary>
    public sealed class Skeleton
    {
        public string[] Names { get; }

        /// <summary>[J] parent of each joint, -1 for none.</summary>
        public int[] Parents { get; }

        /// <summary>[J, 4] local rotations of the bind pose, unit.</summary>
        public double[] BindRotations { get; }

        /// <summary>[J, 3] local translations of the bind pose, metres.</summary>
        public double[] BindTranslations { get; }

        /// <summary>[J, 8] dual quaternions from the bind pose's world to each joint.</summary>
        public double[] BindInverse { get; }

        /// <summary>The joint whose path is the character's.</summary>
        public int Root { get; }

        /// <summary>[M] joints beside the root that move in their parents, ascending.</summary>
        public int[] Translated { get; internal set; } = new int[0];

        public int JointCount => Parents.Length;

        /// <summary>A skeleton of these arrays, parents first, which it keeps.</summary>
        public Skeleton(string[] names, int[] parents, double[] bindRotations, double[] bindTranslations, int root)
        {
            Names = names;
            Parents = parents;
            BindRotations = bindRotations;
            BindTranslations = bindTranslations;
            Root = root;
            BindInverse = new double[8 * parents.Length];
            InvertBind();
        }

        /// <summary>The joints above one, nearest first.</summary>
        public IEnumerable<int> Ancestors(int joint)
        {
            for (int above = Parents[joint]; above >= 0; above = Parents[above])
            {
                yield return above;
            }
        }

        /// <summary>
        /// Forward kinematics: world rotations [J, 4] and positions [J, 3], metres, of local rotations [J, 4] and
        /// local translations [J, 3].
        /// </summary>
        public void World(
            ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations, Span<double> turned, Span<double> placed)
        {
            for (int joint = 0; joint < Parents.Length; joint++)
            {
                QuaternionD rotation = QuaternionD.Load(rotations, joint);
                Vector3D offset = Vector3D.Load(translations, joint);
                int parent = Parents[joint];
                if (parent >= 0)
                {
                    QuaternionD above = QuaternionD.Load(turned, parent);
                    rotation = above * rotation;
                    offset = Vector3D.Load(placed, parent) + above.Rotate(offset);
                }
                rotation.Store(turned, joint);
                offset.Store(placed, joint);
            }
        }

        private void InvertBind()
        {
            var turned = new double[4 * JointCount];
            var placed = new double[3 * JointCount];
            World(BindRotations, BindTranslations, turned, placed);
            for (int joint = 0; joint < JointCount; joint++)
            {
                QuaternionD rotation = QuaternionD.Load(turned, joint);
                DualQuaternion.FromRigid(rotation, Vector3D.Load(placed, joint)).Inverse.Store(BindInverse, joint);
            }
        }
    }
}
