// Runs the sample PosedByRig in the stand-ins' player loop: an avatar's component on a rig that moves. It prints what
// tests/unity/test_posed_by_rig.py asks about.
using System.Globalization;
using StandIns;
using UnityEngine;

namespace Mua.Samples.PosedByRig
{
    internal static class PosedByRigProgram
    {
        private const float Step = 1f / 72;

        public static int Main()
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            Transform rig = new GameObject("rig").transform;
            var mesh = new GameObject("mesh").AddComponent<MeshRenderer>();
            mesh.transform.SetParent(rig, false);
            AddShapes(rig, "teeth", "jawOpen");
            SkinnedMeshRenderer head = AddShapes(rig, "head", "jawOpen", "blink");
            mesh.enabled = true;
            var avatar = new GameObject("avatar").AddComponent<AvatarRenderer>();
            avatar.gameObject.SetActive(false);
            var posed = avatar.gameObject.AddComponent<PosedByRig>();
            posed.Rig = rig;
            avatar.gameObject.SetActive(true);
            Say("posed", avatar.Rig == rig);
            Say("hidden", !mesh.enabled);
            Say("head", avatar.Face == head);
            rig.SetPositionAndRotation(new Vector3(1, 2, 3), Quaternion.Euler(0, 90, 0));
            PlayerLoop.Frame(Step);
            Say("follows", avatar.transform.position == rig.position && avatar.transform.rotation == rig.rotation);
            posed.enabled = false;
            Say("released", avatar.Rig == null && avatar.Face == null && mesh.enabled);
            posed.Rig = null;
            posed.enabled = true;
            Object.DestroyImmediate(rig.gameObject);
            PlayerLoop.Frame(Step);
            Say("quiet", StandIns.Console.Lines.Count == 0);
            return 0;
        }

        private static SkinnedMeshRenderer AddShapes(Transform rig, string name, params string[] shapes)
        {
            var face = new GameObject(name).AddComponent<SkinnedMeshRenderer>();
            face.transform.SetParent(rig, false);
            face.sharedMesh = new Mesh();
            foreach (string shape in shapes)
            {
                face.sharedMesh.AddBlendShapeFrame(shape, 100, new Vector3[0], null, null);
            }
            return face;
        }

        private static void Say(string name, object value)
        {
            System.Console.WriteLine(name + "\t" + value);
        }
    }
}
