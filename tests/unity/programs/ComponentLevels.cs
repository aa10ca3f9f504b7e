// Levels of detail of AvatarRenderer and AvatarBudget in the stand-ins' player loop.
using System.Reflection;
using UnityEngine;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        private const float Near = 1, Far = 2000; // metres behind the avatars

        private static void ChangesLevel()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.IsPlaying = false;
            foreach (float distance in new[] { Near, Far, Near })
            {
                Stand(distance);
                Say("distance", Splats(shown));
            }
            foreach (AvatarLevel level in new[] { AvatarLevel.Half, AvatarLevel.Quarter, AvatarLevel.Full })
            {
                shown.Level = level;
                Say("asked", Splats(shown));
            }
            shown.Level = AvatarLevel.Automatic;
            Stand(Far);
            Camera beside = Beside(new Vector3(0, 0, -Near));
            Say("nearest", Splats(shown));
            beside.enabled = false;
            Say("nearest", Splats(shown));
            Stand(Near);
            Say("nearest", Splats(shown));
            shown.Level = AvatarLevel.Quarter;
            Say("still", Dispatches(2) - Dispatches(1)); // a decode goes before the pose once
            shown.Views = AvatarViews.Splats | AvatarViews.Geometry;
            Say("geometry", Splats(shown));
            shown.Level = AvatarLevel.Automatic;
            Stand(Far);
            Say("geometry", Splats(shown));
        }

        /// <summary>The detailed geometry, in the middle of a clip that plays at the coarsest level.</summary>
        private static void ShowsGeometryWhilePlaying()
        {
            AvatarRenderer shown = Show(files[0]);
            shown.Level = AvatarLevel.Quarter;
            Say("coarse", Splats(shown));
            for (int i = 0; i < 6; i++)
            {
                shown.Views = i % 2 == 0 ? AvatarViews.Splats | AvatarViews.Geometry : AvatarViews.Splats;
                Frames(1);
                Say(i % 2 == 0 ? "geometry" : "splats", shown.SplatCount);
                Frames(6 + i);
            }
        }

        /// <summary>What is shared when an avatar is far away, and then comes near.</summary>
        private static void ComesNear()
        {
            AvatarRenderer shown = Show(files[0]);
            Stand(Far);
            Frames(9);
            shown.Views = AvatarViews.Splats;
            Say("far", Splats(shown));
            Stand(Near);
            Say("near", Splats(shown));
            Say("room", shown.Decoded.Splats.count / 2);
        }

        /// <summary>How large a texel looks: from within the box, from its side, and by a projection whose rows run down.</summary>
        private static void MeasuresTexels()
        {
            AvatarRenderer shown = Show(files[0]);
            Frames(1);
            AvatarInstance instance = (AvatarInstance)typeof(AvatarRenderer)
                .GetField("shown", BindingFlags.Instance | BindingFlags.NonPublic).GetValue(shown);
            Vector3 middle = shown.Bounds.center;
            Matrix4x4 upright = Matrix4x4.Perspective(60, 1, 0.25f, 100), flipped = upright;
            flipped.m11 = -flipped.m11;
            foreach (float away in new[] { 0, shown.Bounds.extents.z + 2 })
            {
                foreach (Matrix4x4 projection in new[] { upright, flipped })
                {
                    var eyes = new AvatarEyes();
                    eyes.Begin(400, 200, 0.25f);
                    Matrix4x4 before = Matrix4x4.Translate(new Vector3(0, 0, away) - middle);
                    eyes.Add(Matrix4x4.Scale(new Vector3(1, 1, -1)) * before, projection);
                    AvatarSeen seen = instance.Sight.Seen(eyes);
                    Say("seen", seen.Distance + " " + seen.Texel / shown.Decoded.Avatar.TexelLength);
                }
            }
            Say("focal", upright.m11 * 100);
            var both = new AvatarEyes();
            both.Begin(400, 200, 0.25f);
            foreach (float aside in new[] { 1, 4 })
            {
                Vector3 eye = middle + new Vector3(shown.Bounds.extents.x + aside, 0, 0);
                both.Add(Matrix4x4.Scale(new Vector3(1, 1, -1)) * Matrix4x4.Translate(-eye), upright);
            }
            Say("between", instance.Sight.Seen(both).Distance);
            shown.transform.localScale = 3 * Vector3.one;
            Frames(1);
            var large = new AvatarEyes();
            large.Begin(400, 200, 0.25f);
            Vector3 at = shown.Bounds.center - new Vector3(0, 0, shown.Bounds.extents.z + 2);
            large.Add(Matrix4x4.Scale(new Vector3(1, 1, -1)) * Matrix4x4.Translate(-at), upright);
            Say("seen", instance.Sight.Seen(large).Distance + " " + instance.Sight.Seen(large).Texel / shown.Decoded.Avatar.TexelLength);
        }

        private static void SharesBudget()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[1]);
            Stand(Near);
            second.transform.position = new Vector3(0, 0, 5);
            var budget = Make("budget").AddComponent<AvatarBudget>();
            foreach (int splats in new[] { 1 << 20, Full(first) + Full(second) - 1, 0 })
            {
                budget.Splats = splats;
                Say("splats", Splats(first) + " " + Splats(second));
            }
            budget.Splats = Full(first) + Full(second) - 1;
            Stand(3);
            Say("one camera", Splats(first) + " " + Splats(second));
            Camera beside = Beside(new Vector3(0, 0, 3.5f));
            Say("two cameras", Splats(first) + " " + Splats(second));
            beside.enabled = false;
            Stand(Near);
            budget.Splats = Full(second);
            second.Level = AvatarLevel.Full;
            Say("fixed", Splats(first) + " " + Splats(second));
            budget.Splats = 1; // which the fixed level alone is beyond
            Say("fixed", Splats(first) + " " + Splats(second));
            budget.Splats = Full(second);
            second.transform.position = new Vector3(0, 0, -1000); // behind the camera
            Say("alone", Splats(first));
            second.transform.position = new Vector3(0, 0, 5);
            AvatarBudget later = Make("later").AddComponent<AvatarBudget>();
            later.Splats = 1 << 20;
            second.Level = AvatarLevel.Automatic;
            budget.Splats = 0;
            Say("later", Splats(first) + " " + Splats(second));
            later.enabled = false;
            Say("earlier", Splats(first) + " " + Splats(second));
            later.enabled = true;
            later.Splats = 0;
            budget.enabled = false;
            Say("later", Splats(first) + " " + Splats(second));
            later.enabled = false;
            Say("free", Splats(first) + " " + Splats(second));
            long before = System.GC.GetAllocatedBytesForCurrentThread();
            Frames(30);
            Say("allocated", System.GC.GetAllocatedBytesForCurrentThread() - before);
        }

        /// <summary>A budget for one of two avatars, of which the other one shows no splats.</summary>
        private static void SharesBudgetWithTemplate()
        {
            AvatarRenderer first = Show(files[0]), second = Show(files[1]);
            Stand(Near);
            second.Views = AvatarViews.Template;
            Make("budget").AddComponent<AvatarBudget>().Splats = Full(first);
            Say("splats", Splats(first));
        }

        private static void LacksLevel()
        {
            AvatarRenderer shown = Show(files[0]);
            Stand(Far);
            Say("splats", Splats(shown));
            shown.Level = AvatarLevel.Half;
            Say("splats", Splats(shown));
            Say("message", shown.Message);
        }

        /// <summary>A level that is picked in the inspector, of an avatar that has none.</summary>
        private static void LevelIsPicked()
        {
            AvatarRenderer shown = Begin(files[0]);
            shown.Level = AvatarLevel.Full;
            Until(shown);
            Say("message", shown.Message);
            typeof(AvatarRenderer).GetField("level", Hidden).SetValue(shown, AvatarLevel.Quarter);
            StandIns.Messages.Send(shown, "OnValidate");
            Frames(1);
            Say("message", shown.Message);
            Say("splats", Splats(shown));
            var budget = Make("budget").AddComponent<AvatarBudget>();
            budget.Splats = -5;
            Say("budget", budget.Splats + " " + AvatarBudget.Limit);
        }

        private static int Full(AvatarRenderer avatar)
        {
            return avatar.Decoded.Avatar.SplatCounts[0];
        }

        private static int Splats(AvatarRenderer avatar)
        {
            Frames(9); // where it plays, another level comes with the next decode
            return avatar.SplatCount;
        }

        /// <summary>A second camera.</summary>
        private static Camera Beside(Vector3 place)
        {
            GameObject made = Make("beside");
            made.transform.position = place;
            return made.AddComponent<Camera>();
        }

        private static void Stand(float distance)
        {
            Scene[0].transform.position = new Vector3(0, 0, -distance);
        }
    }
}
