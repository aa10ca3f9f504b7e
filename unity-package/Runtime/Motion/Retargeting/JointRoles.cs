using System.Collections.Generic;
using System.Linq;

namespace Mua.Motion
{
    /// <summary>
    /// The joints of a figure by their roles, from the root outwards: "hips", "left thigh" (python/mua/pose/joint_names.py).
    /// Roles keep the order in which they were found.
    /// </summary>
    internal sealed class JointRoles
    {
        private static readonly int[] None = new int[0];

        private readonly List<string> order = new List<string>();
        private readonly Dictionary<string, int[]> joints = new Dictionary<string, int[]>();

        /// <summary>Roles that have a joint.</summary>
        public string[] Names => order.ToArray();

        /// <summary>Joints of a role, none where nothing has it; setting none takes the role away.</summary>
        public int[] this[string role]
        {
            get => joints.TryGetValue(role, out int[] found) ? found : None;
            set
            {
                if (value.Length == 0)
                {
                    order.Remove(role);
                    joints.Remove(role);
                    return;
                }
                if (!joints.ContainsKey(role))
                {
                    order.Add(role);
                }
                joints[role] = value;
            }
        }

        public bool Has(string role)
        {
            return joints.ContainsKey(role);
        }

        public void Add(string role, int joint)
        {
            this[role] = this[role].Append(joint).ToArray();
        }

        /// <summary>Every joint that has a role.</summary>
        public IEnumerable<int> Joints => order.SelectMany(role => joints[role]);
    }
}
