using UnityEngine;
using UnityEngine.Playables;
using UnityEngine.Timeline;

namespace Mua
{
    /// <summary>A clip of an avatar on an AvatarTrack; it starts over at its end.</summary>
    public sealed class AvatarClip : PlayableAsset, ITimelineClipAsset
    {
        [SerializeField, Tooltip("Name of the avatar's clip; if empty, the first.")]
        private string clip = "";

        /// <summary>Name of the avatar's clip; if empty, the first. It counts from the next time that the Timeline starts.</summary>
        public string Clip
        {
            get => clip;
            set => clip = value;
        }

        /// <summary>What Timeline offers for it.</summary>
        public ClipCaps clipCaps => ClipCaps.Blending | ClipCaps.ClipIn | ClipCaps.SpeedMultiplier | ClipCaps.Extrapolation;

        public override Playable CreatePlayable(PlayableGraph graph, GameObject owner)
        {
            ScriptPlayable<AvatarClipPlayable> made = ScriptPlayable<AvatarClipPlayable>.Create(graph);
            made.GetBehaviour().Clip = clip;
            return made;
        }
    }
}
