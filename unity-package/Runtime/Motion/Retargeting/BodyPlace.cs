using System;
using System.Collections.Generic;
using System.Linq;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// An avatar's place in a pose: its hips go as those of the other figure do, scaled to its legs, and joints that do not hang
    /// on what carries them in a body stay with it (python/mua/motion/floor.py and detached.py, without looking ahead).
    /// </summary>
    internal sealed class BodyPlace
    {
        private static readonly string[][] CarriedBy =
            new[] { new[] { "spine", "hips" } }.Concat(JointNames.Sides.SelectMany(side => new[]
            {
                new[] { side + " forearm", side + " upper_arm" }, new[] { side + " hand", side + " forearm" },
                new[] { side + " shin", side + " thigh" }, new[] { side + " foot", side + " shin" },
            })).ToArray();

        private const double OnFloor = 0.1; // of the height: a rest pose whose lowest joint is this near to 0 stands on the floor
        private const double Under = 0.25; // of the height: how far below its lowest joint the soles of a figure without toes may be

        private readonly RestPoses rest;
        private readonly Skeleton target;
        private readonly int[] soles; // of the avatar
        private readonly double floor; // of the avatar at rest
        private readonly int[] hips; // of the avatar: where both legs begin, else the hips alone
        private readonly int mover; // whose translation moves the whole body
        private readonly KeyValuePair<int, int>[] detached, attached; // joint and what carries it in a body
        private readonly double[] turned, placed; // joints of the avatar in the world: [T, 4], [T, 3]
        private readonly double scale;

        public BodyPlace(RestPoses rest)
        {
            this.rest = rest;
            target = rest.Target;
            turned = new double[4 * target.JointCount];
            placed = new double[3 * target.JointCount];
            int[] legs = JointNames.Sides.Select(side => rest.Joint(side + " thigh")).Where(joint => joint >= 0).ToArray();
            hips = legs.Length == 2 ? legs : new[] { rest.Joint("hips") }.Where(joint => joint >= 0).ToArray();
            Sources = hips.Select(joint => rest.Matches.First[joint]).ToArray();
            IEnumerable<int> trunk = rest.Matches.Roles["hips"].Concat(rest.Matches.Roles["spine"]);
            mover = trunk.Where(target.Ancestors(target.Root).Contains).DefaultIfEmpty(target.Root).Min();
            soles = JointNames.Sides.SelectMany(side => new[] { rest.Joint(side + " foot"), rest.Joint(side + " toe") })
                .Where(joint => joint >= 0).ToArray();
            floor = FloorOf(Enumerable.Range(0, target.JointCount).Select(joint => Vector3D.Load(rest.TargetAt, joint).Y), Under);
            KnowsFloor = soles.Length == 0 || FloorOf(rest.SourcePlaces().Values.Select(at => at.Y)) == 0;
            scale = LegScale();
            detached = FindDetached().ToArray();
            attached = FindAttached().ToArray();
        }

        /// <summary>Joints of the other figure whose middle its hips are; none where nothing moves the avatar's.</summary>
        public int[] Sources { get; }

        /// <summary>Whether the other figure stands on its floor at rest, or the avatar has no feet to stand on.</summary>
        public bool KnowsFloor { get; }

        /// <summary>Turns detached joints with the trunk. rotations: [T, 4] local; world: [T, 4] of the joints that are led.</summary>
        public void Turn(Span<double> rotations, ReadOnlySpan<double> world)
        {
            foreach (KeyValuePair<int, int> pair in detached)
            {
                QuaternionD above = QuaternionD.Load(world, target.Parents[pair.Key]);
                QuaternionD own = QuaternionD.Load(rest.TargetTurned, pair.Key);
                QuaternionD local = above.Conjugate * Since(world, pair.Value) * own;
                local.Normalized().Store(rotations, pair.Key);
            }
        }

        /// <summary>
        /// Writes local translations [T, 3] of a pose of local rotations [T, 4] whose hips have gone as far as those of the other
        /// figure, by `gone` metres of its own since it was at rest, and then up by `lift` metres.
        /// </summary>
        public void Place(ReadOnlySpan<double> rotations, Span<double> translations, Vector3D gone, double lift = 0)
        {
            target.BindTranslations.CopyTo(translations);
            Attach(rotations, translations);
            if (hips.Length == 0)
            {
                return;
            }
            target.World(rotations, translations, turned, placed);
            Vector3D shift = Middle(rest.TargetAt, hips) + scale * gone + lift * Directions.Y - Middle(placed, hips);
            target.BindTranslations.CopyTo(translations);
            int parent = target.Parents[mover];
            QuaternionD above = parent < 0 ? QuaternionD.Identity : QuaternionD.Load(turned, parent);
            Vector3D moved = Vector3D.Load(translations, mover) + above.Conjugate.Rotate(shift);
            moved.Store(translations, mover);
            Attach(rotations, translations);
        }

        /// <summary>How high above the floor the lower foot of a pose is, as at rest.</summary>
        public double FootHeight(ReadOnlySpan<double> rotations, ReadOnlySpan<double> translations)
        {
            target.World(rotations, translations, turned, placed);
            double lowest = double.PositiveInfinity;
            foreach (int joint in soles)
            {
                lowest = Math.Min(lowest, Vector3D.Load(placed, joint).Y - Vector3D.Load(rest.TargetAt, joint).Y);
            }
            return lowest + floor;
        }

        /// <summary>The middle of some joints' places.</summary>
        public static Vector3D Middle(ReadOnlySpan<double> at, int[] joints)
        {
            var sum = new Vector3D();
            foreach (int joint in joints)
            {
                sum += Vector3D.Load(at, joint);
            }
            return 1.0 / joints.Length * sum;
        }

        /// <summary>Puts joints that do not hang on what carries them in a body where that ends: hands and feet of rigs for IK.</summary>
        private void Attach(ReadOnlySpan<double> rotations, Span<double> translations)
        {
            foreach (KeyValuePair<int, int> pair in attached)
            {
                target.World(rotations, translations, turned, placed);
                Vector3D offset = Vector3D.Load(rest.TargetAt, pair.Key) - Vector3D.Load(rest.TargetAt, pair.Value);
                Vector3D wanted = Vector3D.Load(placed, pair.Value) + Since(turned, pair.Value).Rotate(offset);
                int parent = target.Parents[pair.Key];
                if (parent >= 0)
                {
                    wanted = QuaternionD.Load(turned, parent).Conjugate.Rotate(wanted - Vector3D.Load(placed, parent));
                }
                wanted.Store(translations, pair.Key);
            }
        }

        /// <summary>How far a joint of the avatar has turned in the world since it was at rest.</summary>
        private QuaternionD Since(ReadOnlySpan<double> world, int joint)
        {
            return QuaternionD.Load(world, joint) * QuaternionD.Load(rest.TargetTurned, joint).Conjugate;
        }

        private IEnumerable<KeyValuePair<int, int>> FindAttached()
        {
            IEnumerable<KeyValuePair<int, int>> limbs =
                CarriedBy.Select(roles => new KeyValuePair<int, int>(rest.Joint(roles[0]), rest.Joint(roles[1])));
            return limbs.Where(pair => pair.Key >= 0 && pair.Value >= 0).Concat(detached).Where(
                pair => !target.Ancestors(pair.Key).Contains(pair.Value) && !target.Ancestors(pair.Value).Contains(pair.Key));
        }

        /// <summary>
        /// The topmost joints that nothing moves and that hang on no moved joint, each with the joint of the trunk nearest to it.
        /// </summary>
        private IEnumerable<KeyValuePair<int, int>> FindDetached()
        {
            JointMatches matches = rest.Matches;
            int[] trunk = new[] { "hips", "spine" }.SelectMany(role => matches.Roles[role]).Where(matches.Has).ToArray();
            var carrying = new HashSet<int>(
                Enumerable.Range(0, target.JointCount).Where(matches.Has).SelectMany(joint => target.Ancestors(joint)));
            for (int joint = 0; joint < target.JointCount && trunk.Length > 0; joint++)
            {
                int parent = target.Parents[joint];
                bool isMoved = matches.Has(joint) || carrying.Contains(joint) || !carrying.Contains(parent);
                if (!isMoved && !matches.Has(parent) && !target.Ancestors(parent).Any(matches.Has))
                {
                    Vector3D at = Vector3D.Load(rest.TargetAt, joint);
                    int nearest = trunk.OrderBy(one => Directions.Length(Vector3D.Load(rest.TargetAt, one) - at)).First();
                    yield return new KeyValuePair<int, int>(joint, nearest);
                }
            }
        }

        /// <summary>Size of the avatar over that of the other figure: by the legs, else by all matched bones.</summary>
        private double LegScale()
        {
            double ours = 0, theirs = 0;
            foreach (string side in JointNames.Sides)
            {
                BothPlaces? thigh = rest.Places(side + " thigh"), shin = rest.Places(side + " shin"), foot = rest.Places(side + " foot");
                if (thigh != null && shin != null && foot != null)
                {
                    Add(shin.Value - thigh.Value, ref ours, ref theirs);
                    Add(foot.Value - shin.Value, ref ours, ref theirs);
                }
            }
            if (ours == 0 || theirs == 0)
            {
                ours = theirs = 0;
                AddAllBones(ref ours, ref theirs);
            }
            return ours > 0 && theirs > 0 ? ours / theirs : 1;
        }

        private void AddAllBones(ref double ours, ref double theirs)
        {
            for (int joint = 0; joint < target.JointCount; joint++)
            {
                int parent = target.Parents[joint];
                if (parent >= 0 && rest.Matches.Has(joint) && rest.Matches.Has(parent))
                {
                    Vector3D from = Vector3D.Load(rest.SourceAt, rest.Matches.First[parent]);
                    Vector3D to = Vector3D.Load(rest.SourceAt, rest.Matches.First[joint]);
                    Vector3D own = Vector3D.Load(rest.TargetAt, joint) - Vector3D.Load(rest.TargetAt, parent);
                    Add(new BothPlaces(own, to - from), ref ours, ref theirs);
                }
            }
        }

        /// <summary>Height of the floor that joints of these heights stand on: 0 where the lowest is near to it.</summary>
        private static double FloorOf(IEnumerable<double> heights, double under = OnFloor)
        {
            double low = heights.Min(), high = heights.Max();
            return low > -OnFloor * (high - low) && low < under * (high - low) ? 0 : low;
        }

        private static void Add(BothPlaces bone, ref double ours, ref double theirs)
        {
            ours += Directions.Length(bone.Target);
            theirs += Directions.Length(bone.Source);
        }
    }
}
