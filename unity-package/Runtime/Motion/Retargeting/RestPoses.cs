using System;
using System.Collections.Generic;
using System.Linq;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>A place on the avatar and that which moves it on the other figure, both at rest, metres.</summary>
    internal readonly struct BothPlaces
    {
        public readonly Vector3D Target;
        public readonly Vector3D Source;

        public BothPlaces(Vector3D target, Vector3D source)
        {
            Target = target;
            Source = source;
        }

        public static BothPlaces operator -(BothPlaces a, BothPlaces b)
        {
            return new BothPlaces(a.Target - b.Target, a.Source - b.Source);
        }

        public static BothPlaces Middle(BothPlaces a, BothPlaces b)
        {
            return new BothPlaces(0.5 * (a.Target + b.Target), 0.5 * (a.Source + b.Source));
        }

        public BothPlaces Select(Func<Vector3D, Vector3D> made)
        {
            return new BothPlaces(made(Target), made(Source));
        }
    }

    /// <summary>
    /// An avatar's and another figure's skeleton at rest in the world, and which joints of the figure move which of the avatar
    /// (`Rest` of python/mua/motion/rest_alignment.py).
    /// </summary>
    internal sealed class RestPoses
    {
        public RestPoses(Skeleton source, Skeleton target, JointMatches matches)
        {
            Source = source;
            Target = target;
            Matches = matches;
            SourceTurned = new double[4 * source.JointCount];
            SourceAt = new double[3 * source.JointCount];
            TargetTurned = new double[4 * target.JointCount];
            TargetAt = new double[3 * target.JointCount];
            source.World(source.BindRotations, source.BindTranslations, SourceTurned, SourceAt);
            target.World(target.BindRotations, target.BindTranslations, TargetTurned, TargetAt);
        }

        public Skeleton Source { get; }

        public Skeleton Target { get; }

        public JointMatches Matches { get; }

        /// <summary>[S, 4] joint-to-world rotations.</summary>
        public double[] SourceTurned { get; }

        /// <summary>[S, 3] metres.</summary>
        public double[] SourceAt { get; }

        /// <summary>[T, 4] joint-to-world rotations.</summary>
        public double[] TargetTurned { get; }

        /// <summary>[T, 3] metres.</summary>
        public double[] TargetAt { get; }

        /// <summary>The avatar's first joint of a role that something moves; -1 for none.</summary>
        public int Joint(string role)
        {
            foreach (int joint in Matches.Roles[role])
            {
                if (Matches.Has(joint))
                {
                    return joint;
                }
            }
            return -1;
        }

        /// <summary>Where a role begins; null where it is not matched.</summary>
        public BothPlaces? Places(string role)
        {
            int joint = Joint(role);
            return joint < 0 ? (BothPlaces?)null : At(joint, Matches.First[joint]);
        }

        /// <summary>The places of the left and the right part; null where one is not matched.</summary>
        public BothPlaces[] Sides(string part)
        {
            BothPlaces? left = Places("left " + part), right = Places("right " + part);
            return left == null || right == null ? null : new[] { left.Value, right.Value };
        }

        /// <summary>Where the bone of a role ends: at role `end`, else where its chain goes on; null where that is unknown.</summary>
        public BothPlaces? Ends(string role, string end)
        {
            BothPlaces? matched = Places(end);
            int target = Next(Target, TargetAt, Matches.Roles, role, end), source = Next(Source, SourceAt, Matches.SourceRoles, role, end);
            return matched ?? (target < 0 || source < 0 ? (BothPlaces?)null : At(target, source));
        }

        /// <summary>Where the matched roles begin on the other figure.</summary>
        public Dictionary<string, Vector3D> SourcePlaces()
        {
            return Matches.Roles.Names.Where(role => Places(role) != null).ToDictionary(role => role, role => Places(role).Value.Source);
        }

        /// <summary>The first joint that hangs on another; -1 for none.</summary>
        public static int FirstChild(Skeleton skeleton, int joint)
        {
            return Array.IndexOf(skeleton.Parents, joint);
        }

        private BothPlaces At(int target, int source)
        {
            return new BothPlaces(Vector3D.Load(TargetAt, target), Vector3D.Load(SourceAt, source));
        }

        /// <summary>The joint of role `end`; where there is none, as in arms that end in fingers, the next of the longest chain.</summary>
        private static int Next(Skeleton skeleton, double[] at, JointRoles roles, string role, string end)
        {
            if (roles.Has(end) || !roles.Has(role))
            {
                return roles.Has(end) ? roles[end][0] : -1;
            }
            LongestTail(skeleton, at, roles[role].Last(), out int next);
            return next;
        }

        /// <summary>Length of the longest chain of bones below a joint, and its first joint; -1 for none.</summary>
        private static double LongestTail(Skeleton skeleton, double[] at, int joint, out int next)
        {
            double longest = -1;
            next = -1;
            for (int child = joint + 1; child < skeleton.JointCount; child++)
            {
                if (skeleton.Parents[child] == joint)
                {
                    double bone = Directions.Length(Vector3D.Load(at, child) - Vector3D.Load(at, joint));
                    double length = bone + LongestTail(skeleton, at, child, out _);
                    next = length > longest ? child : next;
                    longest = Math.Max(longest, length);
                }
            }
            return Math.Max(longest, 0);
        }
    }
}
