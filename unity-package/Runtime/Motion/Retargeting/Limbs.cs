using System.Collections.Generic;
using System.Linq;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// Roles of all joints of a figure: what a file states, else what names tell, settled by how the joints hang on each other
    /// (`roles` of python/mua/pose/joint_names.py).
    /// </summary>
    internal static class Limbs
    {
        private static readonly KeyValuePair<string, string>[] Below =
        {
            new KeyValuePair<string, string>("upper_arm", "forearm"), new KeyValuePair<string, string>("forearm", "hand"),
            new KeyValuePair<string, string>("thigh", "shin"), new KeyValuePair<string, string>("shin", "foot"),
        };

        /// <summary>Joints of every role; `stated` [J]: roles that are known otherwise, null where they are not.</summary>
        public static JointRoles Find(Skeleton skeleton, string[] stated = null)
        {
            var found = new JointRoles();
            string[] named = JointNames.Roles(skeleton.Names);
            for (int joint = 0; joint < named.Length; joint++)
            {
                if (named[joint] != null)
                {
                    found.Add(named[joint], joint);
                }
            }
            foreach (string side in JointNames.Sides)
            {
                SettleSide(found, side + " ");
                LeaveOutTargets(skeleton, found, side + " ");
            }
            foreach (string role in found.Names)
            {
                found[role] = OneChain(skeleton, found[role]);
            }
            JointRoles chains = WithStated(found, stated ?? new string[0]);
            KeepToLimbs(skeleton, chains);
            SettleLegs(skeleton, chains);
            SettleTrunk(skeleton, chains);
            return chains;
        }

        private static JointRoles WithStated(JointRoles found, string[] stated)
        {
            var filed = new JointRoles();
            for (int joint = 0; joint < stated.Length; joint++)
            {
                if (stated[joint] != null)
                {
                    filed.Add(stated[joint], joint);
                }
            }
            var taken = new HashSet<int>(filed.Joints);
            var chains = new JointRoles();
            foreach (string role in found.Names.Where(role => !filed.Has(role)))
            {
                chains[role] = found[role].Where(joint => !taken.Contains(joint)).ToArray();
            }
            foreach (string role in filed.Names)
            {
                chains[role] = filed[role];
            }
            return chains;
        }

        /// <summary>Settles names whose part depends on their neighbours: SMPL's foot is the toe, its shoulder the upper arm.</summary>
        private static void SettleSide(JointRoles found, string side)
        {
            if (found.Has(side + "ankle"))
            {
                Rename(found, side + "foot", side + "toe");
                Rename(found, side + "ankle", side + "foot");
            }
            if (!found.Has(side + "upper_arm"))
            {
                Rename(found, side + "shoulder", side + "upper_arm");
            }
            Rename(found, side + "collar", side + "shoulder");
            if (!found.Has(side + "thigh"))
            {
                Rename(found, side + "hip", side + "thigh");
            }
            found[side + "hip"] = new int[0];
        }

        private static void Rename(JointRoles found, string old, string name)
        {
            int[] joints = found[old];
            found[old] = new int[0];
            if (joints.Length > 0)
            {
                found[name] = found[name].Concat(joints).OrderBy(joint => joint).ToArray();
            }
        }

        /// <summary>Drops IK targets: they share a name with joints of the limb but do not hang on the limb above.</summary>
        private static void LeaveOutTargets(Skeleton skeleton, JointRoles found, string side)
        {
            foreach (KeyValuePair<string, string> limb in Below)
            {
                int[] above = found[side + limb.Key];
                int[] hanging = found[side + limb.Value].Where(joint => skeleton.Ancestors(joint).Any(above.Contains)).ToArray();
                if (hanging.Length > 0)
                {
                    found[side + limb.Value] = hanging;
                }
            }
        }

        /// <summary>Leaves twist joints out of a limb: they share its name but are not on the way to its end.</summary>
        private static void KeepToLimbs(Skeleton skeleton, JointRoles chains)
        {
            foreach (string role in chains.Names)
            {
                int space = role.LastIndexOf(' ');
                string part = role.Substring(space + 1), end = Below.FirstOrDefault(limb => limb.Key == part).Value;
                int[] below = end == null || space < 0 ? new int[0] : chains[role.Substring(0, space + 1) + end];
                if (below.Length > 0)
                {
                    int[] way = skeleton.Ancestors(below[0]).ToArray(), kept = chains[role].Where(way.Contains).ToArray();
                    chains[role] = kept.Length > 0 ? kept : chains[role];
                }
            }
        }

        /// <summary>
        /// A leg above a knee, or one that hangs on what carries the other too, is the thigh; the last of a foot's joints its toe.
        /// </summary>
        private static void SettleLegs(Skeleton skeleton, JointRoles chains)
        {
            int[] shins = First(chains, "shin");
            int[] carrying = shins.Length == 2 ? Shared(skeleton, shins) : new int[0];
            foreach (string side in JointNames.Sides)
            {
                int[] shin = chains[side + " shin"], foot = chains[side + " foot"];
                bool isLeg = shin.Length > 1 || (shin.Length > 0 && carrying.Contains(skeleton.Parents[shin[0]]));
                if (!chains.Has(side + " thigh") && isLeg)
                {
                    chains[side + " thigh"] = shin.Take(1).ToArray();
                    chains[side + " shin"] = shin.Skip(1).ToArray();
                }
                if (foot.Length > 1 && !chains.Has(side + " toe"))
                {
                    chains[side + " foot"] = foot.Take(foot.Length - 1).ToArray();
                    chains[side + " toe"] = foot.Skip(foot.Length - 1).ToArray();
                }
            }
        }

        /// <summary>Hips carry both legs and the spine; it ends where the arms begin, and neck and head go on from there.</summary>
        private static void SettleTrunk(Skeleton skeleton, JointRoles chains)
        {
            int[] legs = First(chains, "thigh"), arms = First(chains, "upper_arm"), spine = chains["spine"];
            int[] carrying = legs.Length == 2 ? Shared(skeleton, legs) : new int[0];
            int[] below = spine.Where(carrying.Contains).ToArray();
            if (below.Length > 0 && !chains.Has("hips"))
            {
                chains["hips"] = below;
            }
            int[] hips = chains.Has("hips") ? chains["hips"] : new[] { skeleton.Root };
            if (carrying.Length > 0 && !hips.Any(carrying.Contains))
            {
                int[] above = skeleton.Ancestors(hips[0]).Where(carrying.Contains).ToArray();
                hips = above.Length > 0 ? new[] { above.Max() }.Concat(hips).ToArray() : hips;
            }
            chains["hips"] = hips;
            spine = spine.Where(joint => !hips.Contains(joint)).ToArray();
            int[] reach = arms.Length > 0 ? arms.SelectMany(arm => skeleton.Ancestors(arm)).ToArray() : spine;
            int[] beyond = spine.Any(reach.Contains) ? spine.Where(joint => !reach.Contains(joint)).ToArray() : new int[0];
            if (beyond.Length > 1 && !chains.Has("neck") && !chains.Has("head"))
            {
                chains["neck"] = beyond;
                spine = spine.Where(joint => !beyond.Contains(joint)).ToArray();
            }
            int[] neck = chains["neck"];
            if (neck.Length > 1 && !chains.Has("head"))
            {
                chains["neck"] = neck.Take(neck.Length - 1).ToArray();
                chains["head"] = neck.Skip(neck.Length - 1).ToArray();
            }
            chains["spine"] = spine.Length > 0 ? spine : UnnamedSpine(skeleton, chains, arms);
        }

        /// <summary>The joints from the hips to where both arms branch off, or a body that carries arms and hips.</summary>
        private static int[] UnnamedSpine(Skeleton skeleton, JointRoles chains, int[] arms)
        {
            if (arms.Length < 2)
            {
                return new int[0];
            }
            int hips = chains["hips"].Last();
            int[] carrying = Shared(skeleton, arms), known = chains.Joints.ToArray();
            int[] above = carrying.Where(joint => !known.Contains(joint) && skeleton.Ancestors(joint).Contains(hips)).ToArray();
            if (above.Length > 0 || carrying.Length == 0 || !skeleton.Ancestors(hips).Contains(carrying.Max()))
            {
                return above.OrderBy(joint => joint).ToArray();
            }
            return new[] { carrying.Max() };
        }

        /// <summary>The first joint of a part on each side that has it.</summary>
        private static int[] First(JointRoles chains, string part)
        {
            return JointNames.Sides.SelectMany(side => chains[side + " " + part].Take(1)).ToArray();
        }

        /// <summary>The joints that are above all of some.</summary>
        private static int[] Shared(Skeleton skeleton, int[] joints)
        {
            return skeleton.Ancestors(joints[0]).Where(above => joints.All(joint => skeleton.Ancestors(joint).Contains(above))).ToArray();
        }

        private static int[] OneChain(Skeleton skeleton, int[] joints)
        {
            var chain = new List<int>(joints.Take(1));
            foreach (int joint in joints.Skip(1))
            {
                if (skeleton.Ancestors(joint).Contains(chain[chain.Count - 1]))
                {
                    chain.Add(joint);
                }
            }
            return chain.ToArray();
        }
    }
}
