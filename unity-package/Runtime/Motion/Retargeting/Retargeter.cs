using System;
using System.Collections.Generic;
using System.Linq;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// Puts poses of another figure onto an avatar as they come, by what every bone does in the world: the rotations of
    /// python/mua/motion/retarget.py for a figure that stands at rest. The path of the hips is scaled to the avatar's legs; where
    /// the figure does not stand on its floor at rest, the avatar's height follows its feet, as in python/mua/live/retargeting.py.
    /// </summary>
    public sealed class Retargeter
    {
        private readonly RestPoses rest;
        private readonly BodyPlace place;
        private readonly Footing footing; // null where the figure stands on its floor at rest
        private readonly QuaternionD facing; // from where the figure faces at rest to where the avatar does
        private readonly Vector3D hipsAtRest; // of the figure, turned to face as the avatar does
        private readonly QuaternionD[] bound; // [T] of joints that something moves
        private readonly double[] world; // [T, 4]

        /// <summary>
        /// `source`: the figure, its bind pose being its rest pose; `stated` [S]: roles of its joints where the rig tells them,
        /// null for those known by name; `mapping`: the figure's joint for joints of the avatar that names do not tell.
        /// InvalidOperationException where they do not fit, with a sentence.
        /// </summary>
        public Retargeter(
            Skeleton source, Skeleton target, string[] stated = null, IReadOnlyDictionary<string, string> mapping = null)
        {
            var matches = new JointMatches(source, target, stated, mapping ?? new Dictionary<string, string>());
            rest = new RestPoses(source, target, matches);
            if (!StandingBody.Is(rest.SourcePlaces()))
            {
                throw new InvalidOperationException(
                    "its rest pose shows no body that stands, as in a T-pose, so that it does not tell how its joints lie.");
            }
            var alignment = new RestAlignment(rest);
            place = new BodyPlace(rest);
            footing = place.KnowsFloor ? null : new Footing();
            facing = Descriptor.HeadingOf(alignment.Body).Conjugate;
            hipsAtRest = place.Sources.Length == 0
                ? new Vector3D()
                : facing.Rotate(BodyPlace.Middle(rest.SourceAt, place.Sources));
            world = new double[4 * target.JointCount];
            bound = new QuaternionD[target.JointCount];
            for (int joint = 0; joint < bound.Length; joint++)
            {
                bound[joint] = matches.Has(joint) ? alignment.Bound(joint) : QuaternionD.Identity;
            }
            Used = matches.Last.Concat(place.Sources).Where(joint => joint >= 0).Distinct().OrderBy(joint => joint).ToArray();
        }

        /// <summary>Joints of the figure that a pose is read from, ascending.</summary>
        public int[] Used { get; }

        /// <summary>Whether the avatar stays where it stands, but for going up and down, wherever the figure goes.</summary>
        public bool InPlace { get; set; }

        /// <summary>
        /// From the figure's joints in the world, [S, 4] rotations and [S, 3] metres, of which those in Used are read, to the
        /// avatar's pose at a time: local rotations [T, 4], unit, and local translations [T, 3], metres.
        /// </summary>
        public void Pose(
            ReadOnlySpan<double> turned, ReadOnlySpan<double> placed, double seconds, Span<double> rotations,
            Span<double> translations)
        {
            Skeleton target = rest.Target;
            for (int joint = 0; joint < target.JointCount; joint++)
            {
                int parent = target.Parents[joint];
                QuaternionD above = parent < 0 ? QuaternionD.Identity : QuaternionD.Load(world, parent);
                QuaternionD local = QuaternionD.Load(target.BindRotations, joint), moved = above * local;
                if (rest.Matches.Has(joint))
                {
                    moved = facing * QuaternionD.Load(turned, rest.Matches.Last[joint]) * bound[joint];
                    local = (above.Conjugate * moved).Normalized();
                }
                moved.Store(world, joint);
                local.Store(rotations, joint);
            }
            place.Turn(rotations, world);
            Vector3D gone = place.Sources.Length == 0 ? new Vector3D() : Gone(placed);
            place.Place(rotations, translations, gone);
            if (footing != null)
            {
                place.Place(rotations, translations, gone, footing.Lift(seconds, place.FootHeight(rotations, translations)));
            }
        }

        /// <summary>The role of a bone of Unity's HumanBodyBones, by its name; null for one that has none, as an eye.</summary>
        public static string HumanoidRole(string bone)
        {
            string own = char.ToLowerInvariant(bone[0]) + bone.Substring(1);
            return JointWords.Humanoid.TryGetValue(own, out string role) ? role : null;
        }

        private Vector3D Gone(ReadOnlySpan<double> placed)
        {
            Vector3D gone = facing.Rotate(BodyPlace.Middle(placed, place.Sources)) - hipsAtRest;
            return InPlace ? new Vector3D(0, gone.Y, 0) : gone;
        }
    }
}
