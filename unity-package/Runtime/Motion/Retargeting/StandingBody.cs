using System.Collections.Generic;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// Whether a rest pose is that of somebody who stands: a frame of some motion is none, as what its limbs do would pass for
    /// what limbs do at rest (`stands` of python/mua/motion/trunk.py).
    /// </summary>
    internal sealed class StandingBody
    {
        private const double Wide = 0.1; // of the way between the shoulders: collar bones farther apart show left and right
        private const double Hanging = 60; // degrees from straight down within which legs point
        private const double Raised = 45; // degrees from straight up within which upper arms do not point
        private const double Mirrored = 15; // degrees by which a limb may differ from the mirror image of the other
        private const double KneeStraight = 20, ElbowStraight = 45; // degrees by which they may bend at rest
        private const double Pointed = 20; // degrees between shin and foot below which the foot only continues the leg

        private static readonly string[][] Bones =
        {
            new[] { "thigh", "shin" }, new[] { "shin", "foot" }, new[] { "upper_arm", "forearm" },
            new[] { "forearm", "hand" }, new[] { "foot", "toe" },
        };

        private readonly Dictionary<string, Vector3D> at; // where roles begin
        private readonly Dictionary<string, Vector3D> bones = new Dictionary<string, Vector3D>();
        private Vector3D up, across;

        private StandingBody(Dictionary<string, Vector3D> at)
        {
            this.at = at;
        }

        /// <summary>Whether places of roles are those of a body made to stand: legs down and straight, arms not up, sides alike.</summary>
        public static bool Is(Dictionary<string, Vector3D> places)
        {
            var body = new StandingBody(places);
            if (!body.FindTrunk())
            {
                return false;
            }
            body.FindBones();
            foreach (string role in body.bones.Keys)
            {
                if (!body.IsAtRest(role))
                {
                    return false;
                }
            }
            return true;
        }

        private bool FindTrunk()
        {
            Vector3D? bottom = Middle("thigh") ?? At("hips");
            Vector3D? top = Middle("upper_arm") ?? Middle("shoulder") ?? At("neck") ?? At("head");
            Vector3D? legs = Line("thigh"), arms = Line("upper_arm"), collars = Line("shoulder");
            bool areWide = arms != null && collars != null
                && Directions.Length(collars.Value) > Wide * Directions.Length(arms.Value);
            Vector3D? shoulders = areWide ? collars : arms ?? collars, hips = legs ?? shoulders, chest = shoulders ?? legs;
            if (top == null || bottom == null || hips == null || chest == null)
            {
                return false;
            }
            up = Directions.Unit(top.Value - bottom.Value);
            across = Directions.Unit(Vector3D.Cross(up, Vector3D.Cross(Directions.Unit(hips.Value), up)));
            return Directions.Length(up) > 0 && Directions.Length(hips.Value) > 0 && Directions.Length(chest.Value) > 0;
        }

        private void FindBones()
        {
            foreach (string[] bone in Bones)
            {
                foreach (string side in JointNames.Sides)
                {
                    Vector3D? from = At(side + " " + bone[0]), to = At(side + " " + bone[1]);
                    if (from != null && to != null)
                    {
                        bones[side + " " + bone[0]] = Directions.Unit(to.Value - from.Value);
                    }
                }
            }
        }

        private bool IsAtRest(string role)
        {
            string side = role.Substring(0, role.IndexOf(' ') + 1), part = role.Substring(side.Length);
            Vector3D bone = bones[role];
            switch (part)
            {
                case "thigh":
                    return IsMirrored(part) && Directions.Degrees(bone, -1 * up) <= Hanging;
                case "shin":
                    return IsMirrored(part) && Directions.Degrees(bone, -1 * up) <= Hanging
                        && Bend(side + "thigh", bone) <= KneeStraight;
                case "upper_arm":
                    return IsMirrored(part) && Directions.Degrees(bone, up) >= Raised;
                case "forearm":
                    return IsMirrored(part) && Bend(side + "upper_arm", bone) <= ElbowStraight;
                default:
                    return !bones.ContainsKey(side + "shin") || Bend(side + "shin", bone) >= Pointed;
            }
        }

        /// <summary>Degrees between a bone and the one above; 0 where there is none.</summary>
        private double Bend(string above, Vector3D bone)
        {
            return bones.TryGetValue(above, out Vector3D upper) ? Directions.Degrees(bone, upper) : 0;
        }

        private bool IsMirrored(string part)
        {
            if (!bones.TryGetValue("left " + part, out Vector3D left) || !bones.TryGetValue("right " + part, out Vector3D right))
            {
                return true;
            }
            return Directions.Degrees(left, right - 2 * Directions.Dot(right, across) * across) <= Mirrored;
        }

        private Vector3D? At(string role)
        {
            return at.TryGetValue(role, out Vector3D place) ? place : (Vector3D?)null;
        }

        private Vector3D? Line(string part)
        {
            Vector3D? left = At("left " + part), right = At("right " + part);
            return left == null || right == null ? (Vector3D?)null : left.Value - right.Value;
        }

        private Vector3D? Middle(string part)
        {
            Vector3D? left = At("left " + part), right = At("right " + part);
            return left == null || right == null ? (Vector3D?)null : 0.5 * (left.Value + right.Value);
        }
    }
}
