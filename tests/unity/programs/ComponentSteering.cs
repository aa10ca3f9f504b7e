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
