using System;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// The motion descriptor: the MLPs' view of a window of poses, and its components; the same numbers as
    /// python/mua/pose/descriptor.py and components.py.
    /// </summary>
    public sealed class Descriptor
    {
        private const double NoTwist = 1.4901161193847656e-08; // square root of double's machine epsilon

        private readonly Skeleton skeleton;
        private readonly PoseEncoding encoding;
        private readonly Components components;
        private readonly double[] normal; // the descriptor, normalised
        private readonly double[] turned, placed; // joints in the world: [J, 4], [J, 3]

        public Descriptor(Skeleton skeleton, PoseEncoding encoding)
        {
            this.skeleton = skeleton;
            this.encoding = encoding;
            components = new Components(encoding);
            normal = new double[encoding.Width];
            turned = new double[4 * skeleton.JointCount];
            placed = new double[3 * skeleton.JointCount];
        }

        /// <summary>K: numbers that Write fills.</summary>
        public int Count => encoding.ComponentCount;

        /// <summary>
        /// From local rotations [k, J, 4], unit, and local translations [k, J, 3], metres, both newest first, to
        /// `target` [K], what the first layers read; the share of the pose that training did not show, 0 to 1.
        /// </summary>
        public double Write(ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations, Span<float> target)
        {
            Describe(rotations, translations);
            return components.Read(normal, target);
        }

        /// <summary>The twist about Y; identity where a rotation has none (swing-twist decomposition).</summary>
        public static QuaternionD HeadingOf(QuaternionD turn)
        {
            var twist = new QuaternionD(turn.W, 0, turn.Y, 0);
            return twist.Length < NoTwist ? QuaternionD.Identity : twist.Normalized();
        }

        private void Describe(ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations)
        {
            int joints = skeleton.JointCount, at = 0;
            var origin = new Vector3D();
            QuaternionD back = QuaternionD.Identity;
            for (int age = 0; age < encoding.Window; age++)
            {
                ReadOnlySpan<double> pose = rotations.Slice(4 * joints * age, 4 * joints);
                ReadOnlySpan<double> offsets = translations.Slice(3 * joints * age, 3 * joints);
                skeleton.World(pose, offsets, turned, placed);
                Vector3D position = Vector3D.Load(placed, skeleton.Root);
                if (age == 0)
                {
                    origin = position;
                    back = encoding.Heading ? HeadingOf(Turn(skeleton.Root)).Conjugate : back;
                    foreach (int joint in encoding.Joints)
                    {
                        PutColumns(back * Turn(joint), ref at);
                    }
                }
                Put(back.Rotate(position - origin), ref at);
                PutColumns(back * Turn(skeleton.Root), ref at);
                foreach (int joint in encoding.Joints)
                {
                    PutColumns(QuaternionD.Load(pose, joint), ref at);
                }
                foreach (int joint in encoding.Translated)
                {
                    Put(Vector3D.Load(offsets, joint) - Vector3D.Load(skeleton.BindTranslations, joint), ref at);
                }
            }
        }

        /// <summary>A joint's world rotation relative to the bind pose.</summary>
        private QuaternionD Turn(int joint)
        {
            return QuaternionD.Load(turned, joint) * QuaternionD.Load(skeleton.BindInverse, 2 * joint);
        }

        /// <summary>The first two columns of the rotation's matrix (Zhou et al. 2019, https://arxiv.org/abs/1812.07035).</summary>
        private void PutColumns(QuaternionD q, ref int at)
        {
            double w = q.W, x = q.X, y = q.Y, z = q.Z;
            Put(new Vector3D(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)), ref at);
            Put(new Vector3D(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)), ref at);
        }

        private void Put(Vector3D v, ref int at)
        {
            Put(v.X, ref at);
            Put(v.Y, ref at);
            Put(v.Z, ref at);
        }

        private void Put(double value, ref int at)
        {
            normal[at] = (value - encoding.Mean[at]) / encoding.Scale[at];
            at++;
        }
    }
}
