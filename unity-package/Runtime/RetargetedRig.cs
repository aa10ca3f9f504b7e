using System;
using System.Collections.Generic;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// Says that the rig below has another skeleton than the avatars which it poses, so that its poses are retargeted: put it on
    /// the root that is AvatarRenderer.Rig, beside its Animator. Joints are known by a humanoid Animator, else by their names;
    /// at rest the rig stands as its humanoid avatar has it, else as it does when this component awakes.
    /// </summary>
    [DisallowMultipleComponent, AddComponentMenu("MUA/Retargeted Rig"), DefaultExecutionOrder(-1000)]
    public sealed class RetargetedRig : MonoBehaviour
    {
        [SerializeField, Tooltip("Keeps avatars where they stand: they go up and down with the rig, but not along.")]
        private bool inPlace = false;

        [SerializeField, Tooltip("Which joint of the rig moves a joint of the avatar, where names do not tell.")]
        private JointPair[] joints = new JointPair[0];

        [SerializeField, HideInInspector] private RigRest rest = null; // as the rig stood when the component awoke

        /// <summary>Whether avatars stay where they stand: they go up and down with the rig, but not along.</summary>
        public bool InPlace
        {
            get => inPlace;
            set => inPlace = value;
        }

        /// <summary>The rig at rest, where no humanoid avatar tells: in an editor that does not play, as it stands now.</summary>
        internal RigRest Rest => rest != null && rest.IsTaken && Application.isPlaying ? rest : new RigRest(transform);

        /// <summary>By a joint of the avatar the joint of the rig that moves it.</summary>
        internal Dictionary<string, string> Mapping
        {
            get
            {
                var mapping = new Dictionary<string, string>();
                foreach (JointPair pair in joints)
                {
                    mapping[pair.avatar] = pair.rig;
                }
                return mapping;
            }
        }

        /// <summary>
        /// Lets a joint of the rig move one of the avatar, by their names; it counts for avatars whose Rig is set after it.
        /// </summary>
        public void Map(string avatarJoint, string rigJoint)
        {
            int at = Array.FindIndex(joints, pair => pair.avatar == avatarJoint);
            if (at < 0)
            {
                at = joints.Length;
                Array.Resize(ref joints, at + 1);
            }
            joints[at] = new JointPair { avatar = avatarJoint, rig = rigJoint };
        }

        /// <summary>Takes the pose of this moment for the one at rest; it counts for avatars whose Rig is set after it.</summary>
        public void TakeRest()
        {
            rest = new RigRest(transform);
        }

        private void Awake()
        {
            if (rest == null || !rest.IsTaken) // else this is a clone of a rig that may be moving
            {
                TakeRest();
            }
        }

        /// <summary>A joint of the avatar and the joint of the rig that moves it, by name.</summary>
        [Serializable]
        private struct JointPair
        {
            [Tooltip("Joint of the avatar, as mua-inspect lists it.")] public string avatar;
            [Tooltip("Transform of the rig.")] public string rig;
        }
    }
}
