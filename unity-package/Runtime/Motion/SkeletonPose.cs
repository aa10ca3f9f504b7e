using System;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>A posed skeleton: forward kinematics into arrays made once, then dual quaternions for the kernels.</summary>
    public sealed class SkeletonPose
    {
        private readonly Skeleton skeleton;

        /// <summary>[J, 4] joint-to-world rotations of the last pose.</summary>
        public double[] Turned { get; }

        /// <summary>[J, 3] world positions of the joints, metres.</summary>
        public double[] Placed { get; }

        public SkeletonPose(Skeleton skeleton)
        {
            this.skeleton = skeleton;
            Turned = new double[4 * skeleton.JointCount];
            Placed = new double[3 * skeleton.JointCount];
            Set(skeleton.BindRotations, skeleton.BindTranslations);
        }

        /// <summary>World position of the root joint, metres.</summary>
        public Vector3D RootPosition => Vector3D.Load(Placed, skeleton.Root);

        /// <summary>Takes local rotations [J, 4], unit, and local translations [J, 3], metres.</summary>
        public void Set(ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations)
        {
            skeleton.World(rotations, translations, Turned, Placed);
        }

        /// <summary>What carries bind-pose points to the posed world with one joint.</summary>
        public DualQuaternion Skinning(int joint)
        {
            QuaternionD rotation = QuaternionD.Load(Turned, joint);
            DualQuaternion posed = DualQuaternion.FromRigid(rotation, Vector3D.Load(Placed, joint));
            return posed * DualQuaternion.Load(skeleton.BindInverse, joint);
        }

        /// <summary>All joints' skinning, then `place`, rounded into `target` [J, 8].</summary>
        public void WriteSkinning(in DualQuaternion place, Span<float> target)
        {
            for (int joint = 0; joint < skeleton.JointCount; joint++)
            {
                DualQuaternion skinning = place * Skinning(joint);
                Round(skinning.Real, target, 8 * joint);
                Round(skinning.Dual, target, 8 * joint + 4);
            }
        }

        private static void Round(QuaternionD q, Span<float> target, int at)
        {
            target[at] = (float)q.W;
            target[at + 1] = (float)q.X;
            target[at + 2] = (float)q.Y;
            target[at + 3] = (float)q.Z;
        }
    }
}
