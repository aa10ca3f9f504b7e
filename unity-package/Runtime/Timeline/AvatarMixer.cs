using UnityEngine;
using UnityEngine.Playables;

namespace Mua
{
    /// <summary>
    /// Shows an avatar the moment of its clip, or of the two that overlap, at which a Timeline is; when the Timeline ends, the
    /// avatar goes on as before.
    /// </summary>
    internal sealed class AvatarMixer : PlayableBehaviour
    {
        private AvatarRenderer avatar;
        private string unknown = ""; // the last name that was reported

        public override void ProcessFrame(Playable playable, FrameData info, object playerData)
        {
            var bound = playerData as AvatarRenderer;
            if (!ReferenceEquals(bound, avatar))
            {
                Release();
                avatar = bound;
            }
            if (avatar == null || avatar.Clips.Count == 0)
            {
                return;
            }
            Find(playable, out int first, out int second);
            if (first < 0)
            {
                Release();
            }
            else if (second < 0)
            {
                avatar.Playback.Drive(Clip(playable, first), Time(playable, first));
            }
            else
            {
                float from = playable.GetInputWeight(first), to = playable.GetInputWeight(second);
                avatar.Playback.Drive(
                    Clip(playable, first), Time(playable, first), Clip(playable, second), Time(playable, second),
                    to / (from + to), playable.GetTime());
            }
            Redraw();
        }

        public override void OnPlayableDestroy(Playable playable)
        {
            Release();
        }

        /// <summary>The inputs that count, of which a track has two at most; -1 where there is none.</summary>
        private static void Find(Playable playable, out int first, out int second)
        {
            first = second = -1;
            for (int i = 0; i < playable.GetInputCount() && second < 0; i++)
            {
                if (playable.GetInputWeight(i) > 0)
                {
                    second = first < 0 ? -1 : i;
                    first = first < 0 ? i : first;
                }
            }
        }

        private static double Time(Playable playable, int input)
        {
            return playable.GetInput(input).GetTime();
        }

        /// <summary>Index of the clip that an input names; the first where the avatar has none of that name.</summary>
        private int Clip(Playable playable, int input)
        {
            string name = ((ScriptPlayable<AvatarClipPlayable>)playable.GetInput(input)).GetBehaviour().Clip;
            int found = string.IsNullOrEmpty(name) ? 0 : avatar.Playback.Find(name);
            if (found < 0 && name != unknown)
            {
                unknown = name;
                Debug.LogWarning(
                    "MUA: " + avatar.name + ": the Timeline asks for the clip " + name + ", which the avatar has not; its clips are "
                    + string.Join(", ", avatar.Clips) + ".", avatar);
            }
            return Mathf.Max(found, 0);
        }

        private void Release()
        {
            if (avatar != null)
            {
                avatar.Playback.Release();
                Redraw();
            }
        }

        /// <summary>In an editor that does not play, nothing else runs a frame of the avatar.</summary>
        private static void Redraw()
        {
#if UNITY_EDITOR
            if (!Application.isPlaying)
            {
                UnityEditor.EditorApplication.QueuePlayerLoopUpdate();
            }
#endif
        }
    }
}
