// Transforms that pose an avatar, for the stories of ComponentProgram.cs.
using System.IO;
using Mua.Format;
using Mua.Motion;
using UnityEngine;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        /// <summary>The first avatar and a rig for it: as frame 2 of its first clip, below a root that is moved and turned.</summary>
        private sealed class Rig
        {
            public readonly AvatarFile Avatar = AvatarFile.Read(File.ReadAllBytes(files[0]));
            public readonly Transform Root = Make("rig").transform;
            public readonly Transform[] Joints;

            public Rig()
            {
                Skeleton skeleton = Avatar.Skeleton;
                var rotations = new double[4 * skeleton.JointCount];
                var translations = new double[3 * skeleton.JointCount];
                MakeClip().ReadFrame(2, rotations, translations);
                Root.SetPositionAndRotation(new Vector3(3, -1, 2), Quaternion.Euler(10, 200, -30));
                Joints = new Transform[skeleton.JointCount];
                for (int i = 0; i < Joints.Length; i++)
                {
                    Joints[i] = new GameObject(skeleton.Names[i]).transform;
                    Joints[i].SetParent(skeleton.Parents[i] < 0 ? Root : Joints[skeleton.Parents[i]], false);
                    Joints[i].localPosition = AvatarSpace.Position(Vector3D.Load(translations, i));
                    Joints[i].localRotation = AvatarSpace.Rotation(QuaternionD.Load(rotations, i));
                }
            }

            /// <summary>A joint that no other hangs on.</summary>
            public Transform Last => Joints[Joints.Length - 1];

            /// <summary>The character's root joint.</summary>
            public Transform Hips => Joints[Avatar.Skeleton.Root];

            /// <summary>What the package makes of it.</summary>
            public AvatarJoints Bind()
            {
                return new AvatarJoints(Avatar.Skeleton, Root);
            }

            public ClipSampler MakeClip()
            {
                return new ClipSampler(Avatar.Clips[0], Avatar.Skeleton, Avatar.Encoding.Rate);
            }
        }
    }
}
