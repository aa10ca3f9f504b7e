// What a user of the VR player can see of it, and how it has changed: the other part of PlayerProgram.cs.
using System.Collections.Generic;
using UnityEngine;

namespace Mua.Samples.VrPlayer
{
    internal static partial class PlayerProgram
    {
        private static readonly Dictionary<string, string> Before = new Dictionary<string, string>();

        /// <summary>Ten frames, and what is another than it was.</summary>
        private static void Tell(string what)
        {
            Frames(10);
            Until();
            Dictionary<string, string> now = State();
            List<string> changes = new List<string>();
            foreach (KeyValuePair<string, string> value in now)
            {
                if (Before[value.Key] != value.Value)
                {
                    changes.Add(value.Key + " " + value.Value);
                }
            }
            Say(what, string.Join("; ", changes.ToArray()));
            Remember();
        }

        private static void Remember()
        {
            Before.Clear();
            foreach (KeyValuePair<string, string> value in State())
            {
                Before[value.Key] = value.Value;
            }
        }

        private static Dictionary<string, string> State()
        {
            GameObject help = GameObject.Find("Help");
            return new Dictionary<string, string>
            {
                { "playing", shown.IsPlaying.ToString() },
                { "frame", shown.IsPlaying ? "-" : shown.Frame.ToString() },
                { "clip", shown.ClipIndex.ToString() },
                { "avatar", shown.AvatarName },
                { "views", shown.Views.ToString() },
                { "help", (help != null).ToString() },
                { "user", Format(user.position) },
                { "head", Format(head.transform.forward) },
                { "size", user.localScale.x.ToString("0.000") },
                { "avatar faces", Format(shown.transform.forward) },
            };
        }

        private static string Format(Vector3 v)
        {
            return (v.x + 0f).ToString("0.00") + " " + v.y.ToString("0.00") + " " + v.z.ToString("0.00");
        }
    }
}
