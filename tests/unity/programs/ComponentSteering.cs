// Stories of ComponentProgram.cs: what an application reads of an AvatarRenderer, and what it sets.
using System.Reflection;
using UnityEngine;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        /// <summary>A component that was given nothing to show.</summary>
        private static void IsPlain()
        {
            GameObject thing = Make("avatar");
            thing.transform.position = new Vector3(1, 2, 3);
            AvatarRenderer shown = thing.AddComponent<AvatarRenderer>();
            Frames(2);
            shown.ClipIndex = 1;
            shown.Frame = 3;
            shown.Seconds = 2;
            Say("outside", shown.OutsideTraining);
            Say("plain", shown.State + " '" + shown.Message + "' " + shown.Progress + " '" + shown.AvatarName + "' " + shown.SplatCount);
            Say("clip", shown.ClipIndex + " of " + shown.Clips.Count + ", " + shown.Frame + " of " + shown.FrameCount + ", " + shown.Seconds);
            Say("plays", shown.IsPlaying + " " + shown.Speed + ", " + shown.Views + ", " + shown.Level + ", " + shown.SpreadDecode);
            Say("bounds", shown.Bounds.center.x + " " + shown.Bounds.center.y + " " + shown.Bounds.center.z + " " + shown.Bounds.size.magnitude);
        }

        /// <summary>Numbers and names that mean nothing, what was destroyed, and a clip that plays on after each.</summary>
        private static void IsMisused()
        {
            AvatarRenderer shown = Show(files[0]);
            foreach (double moment in new[] { double.NaN, double.PositiveInfinity, -1e300, 1e300 })
            {
                shown.Seconds = moment;
                Frames(2);
                Say("moment", shown.Frame >= 0 && shown.Frame < shown.FrameCount);
            }
            foreach (int frame in new[] { -1, int.MaxValue, int.MinValue })
            {
                shown.Frame = frame;
                Frames(2);
                Say("moment", shown.Frame >= 0 && shown.Frame < shown.FrameCount);
            }
            shown.Speed = float.NaN;
            Frames(2);
            shown.Speed = 1;
            Frames(36);
            Say("plays", shown.Seconds);
            foreach (AvatarLevel level in new[] { (AvatarLevel)(-7), (AvatarLevel)99 })
            {
                shown.Level = level;
                Frames(2);
                Say("splats", shown.SplatCount);
            }
            foreach (string path in new[] { null, "", "no\0path", "." })
            {
                shown.Load(path);
                Until(shown);
                Say("loaded", shown.State + " " + (shown.Message.Length > 0) + " " + shown.SetExpression("jawOpen", 1));
            }
            shown.Load((AvatarAsset)null);
            Frames(1);
            Say("loaded", shown.State + " " + (shown.Message.Length > 0) + " False");
            Object.DestroyImmediate(shown);
            Object.DestroyImmediate(shown);
            shown.Seconds = 1;
            shown.ResetExpressions();
            Say("destroyed", shown.State + " " + shown.Seconds + " " + shown.SplatCount);
        }

        private static void LeavesTraining()
        {
            AvatarRenderer shown = Begin(files[0]);
            Say("loading", shown.OutsideTraining);
            Until(shown);
            shown.IsPlaying = false;
            foreach (int frame in new[] { 2, 5, 0 })
            {
                shown.Frame = frame;
                Frames(2);
                Say("outside", shown.OutsideTraining);
            }
        }

        private static void Steers()
        {
            AvatarRenderer shown = Show(files[0]);
            Say("progress", shown.Progress);
            Say("name", shown.AvatarName);
            Say("frames", shown.FrameCount);
            foreach (int index in new[] { -1, 99, 1, 0 })
            {
                shown.Frame = 2;
                shown.ClipIndex = index;
                Say("clip", shown.ClipIndex + " " + shown.Frame + " " + shown.FrameCount);
            }
            shown.IsPlaying = false;
            shown.Seconds = 0.25;
            Frames(36);
            Say("still", shown.Seconds);
            shown.IsPlaying = true;
            shown.Seconds = 0;
            Frames(36);
            double half = shown.Seconds;
            Say("half", half);
            shown.Seconds = 0;
            shown.Speed = 0.5f;
            Frames(36);
            Say("slow", shown.Seconds / half);
            shown.Seconds = 1;
            shown.Speed = -0.5f;
            Frames(36);
            Say("back", (1 - shown.Seconds) / half);
            shown.IsPlaying = false;
            foreach (int index in new[] { 0, 2 })
            {
                shown.ClipIndex = index;
                Frames(1);
                Vector3 middle = shown.Bounds.center;
                Say("posed", middle.x + " " + middle.y + " " + middle.z);
            }
            FieldInfo clip = typeof(AvatarRenderer).GetField("clip", BindingFlags.Instance | BindingFlags.NonPublic);
            foreach (string name in new[] { "nobody's", "later" })
            {
                clip.SetValue(shown, name);
                StandIns.Messages.Send(shown, "OnValidate");
                Frames(1);
                Say("picked", shown.ClipIndex + " " + shown.Message);
            }
        }
    }
}
