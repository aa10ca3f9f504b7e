using System;
using System.Collections.Generic;
using System.Linq;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// How the joints of an avatar at rest lie in those of another figure at rest: limb by limb, so that a T-pose, an A-pose and
    /// legs apart all mean the same (python/mua/motion/rest_alignment.py, which says what is done and why).
    /// </summary>
    internal sealed class RestAlignment
    {
        private const double Clearly = 10; // times nearer to the shin's plane than to the vertical: a foot that rolls with its leg

        private static readonly Dictionary<string, string> BoneEnds = new Dictionary<string, string>
        {
            { "upper_arm", "forearm" }, { "forearm", "hand" }, { "thigh", "shin" }, { "shin", "foot" },
        };

        private readonly RestPoses rest;
        private readonly QuaternionD[] turns; // [T] what brings a matched joint from the bind pose to the other figure's rest

        public RestAlignment(RestPoses rest)
        {
            this.rest = rest;
            Body = BodyTurn();
            turns = new QuaternionD[rest.Target.JointCount];
            var parts = new string[turns.Length];
            foreach (string role in rest.Matches.Roles.Names)
            {
                foreach (int joint in rest.Matches.Roles[role])
                {
                    parts[joint] = role;
                }
            }
            for (int joint = 0; joint < turns.Length; joint++) // parents first: each starts from the turn of the joint above
            {
                int above = rest.Target.Parents[joint];
                QuaternionD turn = above < 0 ? Body : turns[above];
                turns[joint] = rest.Matches.Has(joint) ? Turn(joint, parts[joint] ?? "") ?? turn : turn;
            }
        }

        /// <summary>The turn of the whole body; none where it is unknown.</summary>
        public QuaternionD Body { get; }

        /// <summary>
        /// What follows a rotation of the other figure's joint in the world to give that of the avatar's, which it moves.
        /// </summary>
        public QuaternionD Bound(int joint)
        {
            QuaternionD source = QuaternionD.Load(rest.SourceTurned, rest.Matches.Last[joint]);
            return source.Conjugate * turns[joint] * QuaternionD.Load(rest.TargetTurned, joint);
        }

        private QuaternionD BodyTurn()
        {
            BothPlaces? top = rest.Places("head") ?? rest.Places("neck") ?? rest.Places("spine");
            BothPlaces[] legs = rest.Sides("thigh"), wide = legs ?? rest.Sides("upper_arm") ?? rest.Sides("shoulder");
            BothPlaces? bottom = legs == null ? rest.Places("hips") : BothPlaces.Middle(legs[0], legs[1]);
            if (top == null || bottom == null || wide == null)
            {
                return QuaternionD.Identity;
            }
            BothPlaces up = (top.Value - bottom.Value).Select(Directions.NearestAxis), left = wide[0] - wide[1];
            QuaternionD? target = BodyFrame(up.Target, left.Target), source = BodyFrame(up.Source, left.Source);
            return target == null || source == null ? QuaternionD.Identity : source.Value * target.Value.Conjugate;
        }

        private static QuaternionD? BodyFrame(Vector3D up, Vector3D left)
        {
            Vector3D forward = Directions.Unit(Vector3D.Cross(left, up));
            return Directions.Length(forward) > 0
                ? Directions.FromColumns(Vector3D.Cross(up, forward), up, forward)
                : (QuaternionD?)null;
        }

        /// <summary>The turn of a joint; null where it is that of the joint above.</summary>
        private QuaternionD? Turn(int joint, string role)
        {
            int space = role.LastIndexOf(' ');
            string side = role.Substring(0, space + 1), part = role.Substring(space + 1);
            if (part == "foot")
            {
                return SoleTurn(side);
            }
            if (part == "hand")
            {
                return joint == rest.Joint(role) ? PalmTurn(side) : null;
            }
            return BoneEnds.TryGetValue(part, out string end) ? BoneTurn(role, side + end, Above(joint)) : null;
        }

        private QuaternionD Above(int joint)
        {
            int above = rest.Target.Parents[joint];
            return above < 0 ? Body : turns[above];
        }

        /// <summary>The turn above, then the shortest that lays the avatar's bone along the other figure's.</summary>
        private QuaternionD? BoneTurn(string role, string end, QuaternionD above)
        {
            BothPlaces? begins = rest.Places(role), ends = rest.Ends(role, end);
            if (begins == null || ends == null)
            {
                return null;
            }
            BothPlaces bone = (ends.Value - begins.Value).Select(Directions.Unit);
            return Directions.Length(bone.Target) == 0 || Directions.Length(bone.Source) == 0
                ? (QuaternionD?)null
                : Directions.Between(above.Rotate(bone.Target), bone.Source) * above;
        }

        /// <summary>Between the level soles of both.</summary>
        private QuaternionD? SoleTurn(string side)
        {
            BothPlaces? knee = rest.Places(side + "shin"), ankle = rest.Places(side + "foot"), ball = rest.Places(side + "toe");
            int toe = rest.Joint(side + "toe");
            if (knee == null || ankle == null || ball == null || toe < 0)
            {
                return null;
            }
            Vector3D up = Directions.NearestAxis(Body.Rotate(Directions.Y));
            QuaternionD? target = SoleFrame(
                knee.Value.Target, ankle.Value.Target, ball.Value.Target, Tip(rest.Target, rest.TargetAt, toe), Directions.Y);
            QuaternionD? source = SoleFrame(
                knee.Value.Source, ankle.Value.Source, ball.Value.Source,
                Tip(rest.Source, rest.SourceAt, rest.Matches.Last[toe]), up);
            return target == null || source == null ? (QuaternionD?)null : source.Value * target.Value.Conjugate;
        }

        private static Vector3D? Tip(Skeleton skeleton, double[] at, int toe)
        {
            int child = RestPoses.FirstChild(skeleton, toe);
            return child < 0 ? (Vector3D?)null : Vector3D.Load(at, child);
        }

        /// <summary>Left, up and forward of a sole at rest; null where toes point up or nowhere.</summary>
        private static QuaternionD? SoleFrame(Vector3D knee, Vector3D ankle, Vector3D ball, Vector3D? tip, Vector3D up)
        {
            Vector3D foot = ball - ankle, toes = tip == null ? foot : tip.Value - ball;
            Vector3D level = Directions.Unit(Vector3D.Cross(up, toes)), rolled = Directions.Unit(Vector3D.Cross(knee - ankle, toes));
            if (Directions.Length(level) == 0 || Directions.Length(rolled) == 0)
            {
                return null;
            }
            bool rolls = Clearly * Math.Abs(Directions.Dot(rolled, foot)) < Math.Abs(Directions.Dot(level, foot));
            Vector3D left = rolls ? rolled : level, forward = Directions.Unit(Vector3D.Cross(left, up));
            return Directions.FromColumns(left, Vector3D.Cross(forward, left), forward);
        }

        /// <summary>Between the palms of both, by where fingers begin, whichever way a rest pose holds them.</summary>
        private QuaternionD? PalmTurn(string side)
        {
            BothPlaces?[] at = new[] { "hand", "index", "middle", "pinky" }.Select(part => rest.Places(side + part)).ToArray();
            if (at.Any(places => places == null))
            {
                return null;
            }
            QuaternionD? target = Palm(at.Select(places => places.Value.Target).ToArray());
            QuaternionD? source = Palm(at.Select(places => places.Value.Source).ToArray());
            return target == null || source == null ? (QuaternionD?)null : source.Value * target.Value.Conjugate;
        }

        /// <summary>Along the fingers, across the hand and out of its back, of wrist, index, middle and little finger.</summary>
        private static QuaternionD? Palm(Vector3D[] at)
        {
            Vector3D fingers = Directions.Unit(at[2] - at[0]), back = Directions.Unit(Vector3D.Cross(fingers, at[1] - at[3]));
            return Directions.Length(back) == 0
                ? (QuaternionD?)null
                : Directions.FromColumns(fingers, Vector3D.Cross(back, fingers), back);
        }
    }
}
