using UnityEngine;

namespace Mua.Samples.PosedByRig
{
    /// <summary>
    /// Shows an avatar in the place of a rigged character: whatever moves the rig, an Animator, a script or physics, moves the
    /// avatar, and its blend shapes the avatar's expressions. Joints and expressions are found by name.
    /// </summary>
    [RequireComponent(typeof(AvatarRenderer))]
    public sealed class PosedByRig : MonoBehaviour
    {
        [SerializeField, Tooltip("Root of the rigged character that the avatar was baked from; joints are found by name.")]
        private Transform rig = null;

        private AvatarRenderer avatar;
        private Renderer[] hidden = new Renderer[0];

        /// <summary>Root of the rigged character; set it while the component is disabled.</summary>
        public Transform Rig
        {
            get => rig;
            set => rig = value;
        }

        private void OnEnable()
        {
            avatar = GetComponent<AvatarRenderer>();
            avatar.Rig = rig;
            hidden = rig == null ? new Renderer[0] : rig.GetComponentsInChildren<Renderer>();
            avatar.Face = Face();
            Show(false);
        }

        private void OnDisable()
        {
            avatar.Rig = null;
            avatar.Face = null;
            Show(true);
        }

        /// <summary>Before the avatar's own LateUpdate, which reads the joints.</summary>
        private void LateUpdate()
        {
            if (rig != null)
            {
                transform.SetPositionAndRotation(rig.position, rig.rotation);
                Transform above = transform.parent;
                float size = above == null ? 1 : above.lossyScale.x;
                transform.localScale = size > 0 ? rig.lossyScale / size : rig.lossyScale;
            }
        }

        /// <summary>Of the rig's meshes the one with most blend shapes; null where none has any.</summary>
        private SkinnedMeshRenderer Face()
        {
            SkinnedMeshRenderer face = null;
            int most = 0;
            foreach (Renderer mesh in hidden)
            {
                if (mesh is SkinnedMeshRenderer skinned && skinned.sharedMesh != null && skinned.sharedMesh.blendShapeCount > most)
                {
                    face = skinned;
                    most = skinned.sharedMesh.blendShapeCount;
                }
            }
            return face;
        }

        /// <summary>The rig's own meshes.</summary>
        private void Show(bool isShown)
        {
            foreach (Renderer mesh in hidden)
            {
                if (mesh != null)
                {
                    mesh.enabled = isShown;
                }
            }
        }
    }
}
