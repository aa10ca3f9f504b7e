// Stories of ComponentProgram.cs: a Timeline, or an animation of fields, moves an avatar through its clips.
using System;
using System.Linq;
using System.Reflection;
using StandIns;
using UnityEngine;
using UnityEngine.Playables;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        /// <summary>A track with a clip for each name, as the engine makes its graph.</summary>
        private sealed class Graph
        {
            public readonly Playable Mixer;
            private readonly PlayableBehaviour behaviour;
            public AvatarRenderer Avatar; // that the track is bound to

            public Graph(AvatarRenderer avatar, params string[] names)
            {
                Avatar = avatar;
                var track = ScriptableObject.CreateInstance<AvatarTrack>();
                Mixer = track.CreateTrackMixer(default(PlayableGraph), null, names.Length);
                behaviour = ((ScriptPlayable<AvatarMixer>)Mixer).GetBehaviour();
                for (int i = 0; i < names.Length; i++)
                {
                    var clip = ScriptableObject.CreateInstance<AvatarClip>();
                    clip.Clip = names[i];
                    Mixer.ConnectInput(i, clip.CreatePlayable(default(PlayableGraph), null), 0);
                }
            }

            /// <summary>The clips' weights and their own seconds at a moment, and the frame that follows.</summary>
            public void Evaluate(double now, params double[] weightsAndSeconds)
            {
                Mixer.SetTime(now);
                for (int i = 0; i < Mixer.GetInputCount(); i++)
                {
                    Mixer.SetInputWeight(i, (float)weightsAndSeconds[2 * i]);
                    Mixer.GetInput(i).SetTime(weightsAndSeconds[2 * i + 1]);
                }
                behaviour.ProcessFrame(Mixer, default(FrameData), Avatar);
                Frames(1);
            }

            public void Destroy()
            {
                behaviour.OnPlayableDestroy(Mixer);
            }
        }

        private static void PlaysTimeline()
        {
            AvatarRenderer shown = Show(files[0]);
            Say("clips", string.Join(" ", shown.Clips));
            shown.ClipIndex = 1;
            Frames(9);
            double own = shown.Seconds;
            var graph = new Graph(shown, shown.Clips[0], shown.Clips[1]);
            graph.Evaluate(0, 1, 0.1, 0, 0);
            SayMoment("first", shown);
            for (int i = 0; i < 5; i++)
            {
                Frames(1); // a director that is paused, or slower than the display
            }
            SayMoment("paused", shown);
            graph.Evaluate(1, 0, 0, 1, 0.05);
            SayMoment("second", shown);
            graph.Evaluate(0.2, 0.3, 0.02, 0, 0); // scrubbed back, eased in
            SayMoment("scrubbed", shown);
            graph.Evaluate(0.6, 0.75, 0.11, 0.25, 0.07);
            SayPose("blend", shown);
            SayParts(shown);
            graph.Evaluate(0.6, 0.75, 0.11, 0.25, 0.07); // and once more, from elsewhere
            SayPose("again", shown);
            graph.Evaluate(0.7, 0, 0, 0, 0); // between clips
            Say("gap", shown.ClipIndex + " " + (Math.Abs(shown.Seconds - own - Step) < 1e-6));
            graph.Evaluate(0.8, 1, 0.1, 0, 0);
            double[] moments = { 1, 0, 0, 0.1 };
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int i = 0; i < 72; i++)
            {
                moments[1] = i / 72.0;
                moments[2] = i % 2;
                graph.Evaluate(i / 72.0, moments);
            }
            Say("allocated", GC.GetAllocatedBytesForCurrentThread() - before);
            graph.Destroy();
            Frames(1);
            Say("after", shown.ClipIndex);
        }

        private static void SayMoment(string name, AvatarRenderer shown)
        {
            Say(name, shown.ClipIndex + " " + Math.Round(shown.Seconds, 6));
        }

        private static void SayPose(string name, AvatarRenderer shown)
        {
            AvatarPose pose = Current(shown);
            pose.ReadWindow(pose.Due);
            Say(name, string.Join(" ", pose.Current.ToArray()));
            Say(name + " window", string.Join(" ", pose.Window.ToArray()));
            Say(name + " weights", string.Join(" ", shown.ExpressionNames.Select(shown.GetExpression)));
        }

        /// <summary>Local rotations of the moments that the blend above is made of.</summary>
        private static void SayParts(AvatarRenderer shown)
        {
            foreach (Tuple<int, double> moment in new[] { Tuple.Create(0, 0.11), Tuple.Create(1, 0.07) })
            {
                var graph = new Graph(shown, shown.Clips[moment.Item1]);
                graph.Evaluate(5, 1, moment.Item2);
                SayPose("part", shown);
            }
        }

        private static AvatarPose Current(AvatarRenderer shown)
        {
            const BindingFlags Own = BindingFlags.Instance | BindingFlags.NonPublic;
            object instance = typeof(AvatarRenderer).GetField("shown", Own).GetValue(shown);
            return ((AvatarMotion)typeof(AvatarInstance).GetField("motion", Own).GetValue(instance)).Pose;
        }

        private static void AsksForUnknownClip()
        {
            AvatarRenderer shown = Show(files[0]);
            var graph = new Graph(shown, "nobody's");
            graph.Evaluate(0, 1, 0.1);
            graph.Evaluate(0.1, 1, 0.2);
            SayMoment("shown", shown);
        }

        /// <summary>A Timeline that begins before the avatar is there, and outlives it.</summary>
        private static void OutlivesAvatar()
        {
            AvatarRenderer shown = Begin(files[0]);
            var graph = new Graph(shown, "");
            graph.Evaluate(0, 1, 0.1);
            Until(shown);
            graph.Evaluate(0.1, 1, 0.2);
            SayMoment("shown", shown);
            UnityEngine.Object.DestroyImmediate(shown.gameObject);
            graph.Evaluate(0.2, 1, 0.3);
            graph.Destroy();
        }

        private static void ChangesAvatar()
        {
            AvatarRenderer shown = Show(files[0]), other = Show(files[1]);
            Frames(9);
            double own = shown.Seconds;
            var graph = new Graph(shown, "");
            graph.Evaluate(0, 1, 0.1);
            graph.Avatar = other;
            graph.Evaluate(0.1, 1, 0.2);
            Say("left", Math.Abs(shown.Seconds - own - Step) < 1e-6);
            SayMoment("taken", other);
        }

        private static void AnimatesFields()
        {
            AvatarRenderer shown = Make("avatar").AddComponent<AvatarRenderer>();
            Animate(shown, "time", 0.125f);
            Animate(shown, "playing", false);
            shown.Load(files[0]);
            Until(shown);
            SayMoment("begins", shown);
            Frames(10);
            SayMoment("rests", shown);
            shown.Load(files[0]);
            Until(shown);
            SayMoment("reloaded", shown);
            Animate(shown, "time", 0.05f);
            Frames(1);
            SayMoment("goes", shown);
            Animate(shown, "playing", true);
            Frames(9);
            Say("plays", shown.IsPlaying + " " + Math.Round(shown.Seconds, 6));
        }

        private static void Animate(AvatarRenderer shown, string field, object value)
        {
            typeof(AvatarRenderer).GetField(field, BindingFlags.Instance | BindingFlags.NonPublic).SetValue(shown, value);
            Messages.Send(shown, "OnDidApplyAnimationProperties");
        }
    }
}
