using System;
using System.Collections.Generic;
using System.Linq;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>
    /// Which joint of another figure moves which joint of an avatar: by a mapping, by roles, by equal names
    /// (python/mua/motion/match.py, of joints that their names or the rig tell).
    /// </summary>
    internal sealed class JointMatches
    {
        private const double SameRig = 0.8; // of the avatar's joints: with as many equal names, both are of one kind of rig

        private static readonly KeyValuePair<string, string[]>[] Needed =
            JointNames.Sides.SelectMany(side => new[]
            {
                new KeyValuePair<string, string[]>(side + " arm", new[] { side + " upper_arm", side + " forearm" }),
                new KeyValuePair<string, string[]>(side + " leg", new[] { side + " thigh", side + " shin" }),
            }).Append(new KeyValuePair<string, string[]>("spine", new[] { "spine" })).ToArray();

        /// <summary>InvalidOperationException where the mapping names no joint, or nothing moves an arm, a leg or the spine.</summary>
        public JointMatches(Skeleton source, Skeleton target, string[] stated, IReadOnlyDictionary<string, string> mapping)
        {
            First = Enumerable.Repeat(-1, target.JointCount).ToArray();
            Last = Enumerable.Repeat(-1, target.JointCount).ToArray();
            Roles = Limbs.Find(target);
            SourceRoles = Limbs.Find(source, stated);
            int alike = MatchNames(source, target);
            LeaveOutMarkers();
            MatchRoles();
            AddMapped(source, target, mapping);
            foreach (KeyValuePair<string, string> pair in mapping)
            {
                int chosen = IndexOf(source, pair.Value, "the rig"), joint = IndexOf(target, pair.Key, "the avatar");
                First[joint] = Last[joint] = chosen;
            }
            if (alike < SameRig * target.JointCount && mapping.Count == 0)
            {
                RequireLimbs();
            }
        }

        /// <summary>[T] first joint of the chain that moves each joint of the avatar; -1 where nothing does.</summary>
        public int[] First { get; }

        /// <summary>[T] last joint of that chain.</summary>
        public int[] Last { get; }

        /// <summary>Joints of the avatar by role.</summary>
        public JointRoles Roles { get; }

        /// <summary>Joints of the other figure by role.</summary>
        public JointRoles SourceRoles { get; }

        public bool Has(int joint)
        {
            return First[joint] >= 0;
        }

        private int MatchNames(Skeleton source, Skeleton target)
        {
            var places = new Dictionary<string, int>();
            for (int joint = 0; joint < source.JointCount; joint++)
            {
                places[Plain(source.Names[joint])] = joint;
            }
            for (int joint = 0; joint < target.JointCount; joint++)
            {
                if (places.TryGetValue(Plain(target.Names[joint]), out int place))
                {
                    First[joint] = Last[joint] = place;
                }
            }
            return First.Count(place => place >= 0);
        }

        /// <summary>A thumb without fingers is a marker of optical motion capture, which a solver turned wildly.</summary>
        private void LeaveOutMarkers()
        {
            foreach (string side in JointNames.Sides)
            {
                if (!JointNames.Fingers.Skip(1).Any(finger => SourceRoles.Has(side + " " + finger)))
                {
                    SourceRoles[side + " " + JointNames.Fingers[0]] = new int[0];
                }
            }
        }

        /// <summary>Chains of different length share their joints in proportion.</summary>
        private void MatchRoles()
        {
            foreach (string role in Roles.Names)
            {
                int[] joints = Roles[role], chain = SourceRoles[role];
                for (int i = 0; i < joints.Length && chain.Length > 0; i++)
                {
                    First[joints[i]] = chain[i * chain.Length / joints.Length];
                    Last[joints[i]] = chain[((i + 1) * chain.Length + joints.Length - 1) / joints.Length - 1];
                }
            }
        }

        /// <summary>Lets mapped joints without a role take over that of the joint which moves them.</summary>
        private void AddMapped(Skeleton source, Skeleton target, IReadOnlyDictionary<string, string> mapping)
        {
            int[] known = Roles.Joints.ToArray();
            var added = new JointRoles();
            foreach (KeyValuePair<string, string> pair in mapping)
            {
                int joint = Array.IndexOf(target.Names, pair.Key), mover = Array.IndexOf(source.Names, pair.Value);
                string role = SourceRoles.Names.LastOrDefault(name => SourceRoles[name].Contains(mover));
                if (role != null && joint >= 0 && !known.Contains(joint) && !Roles.Has(role))
                {
                    added.Add(role, joint);
                }
            }
            foreach (string role in added.Names)
            {
                Roles[role] = added[role].OrderBy(joint => joint).ToArray();
            }
        }

        private void RequireLimbs()
        {
            bool isSpineless = !Roles.Has("spine") && Roles.Has("left upper_arm"); // arms that grow straight out of the hips
            string[] missing = Needed.Where(limb => !limb.Value.All(part => Roles[part].Any(Has)))
                .Select(limb => limb.Key).Where(limb => limb != "spine" || !isSpineless).ToArray();
            if (missing.Length > 0)
            {
                throw new InvalidOperationException(
                    "nothing of the rig is known to move the avatar's " + string.Join(", ", missing) + "; pair their joints.");
            }
        }

        private static int IndexOf(Skeleton skeleton, string name, string owner)
        {
            int joint = Array.IndexOf(skeleton.Names, name);
            return joint >= 0 ? joint : throw new InvalidOperationException(
                owner + " has no joint \"" + name + "\", only " + string.Join(", ", skeleton.Names.Take(6))
                + (skeleton.JointCount > 6 ? ", ... " + skeleton.JointCount + " in all." : "."));
        }

        private static string Plain(string name)
        {
            string own = JointNames.Namespace.Replace(name, "").ToLowerInvariant();
            return string.Concat(own.Where(letter => (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9')));
        }
    }
}
