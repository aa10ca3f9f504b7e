using UnityEngine;
using UnityEngine.Playables;
using UnityEngine.Timeline;

namespace Mua
{
    /// <summary>
    /// A Timeline track that plays clips of the AvatarRenderer it is bound to; where two overlap, the pose goes from one over into
    /// the other. A rig that poses the avatar goes before it.
    /// </summary>
    [TrackColor(0.86f, 0.55f, 0.33f), TrackClipType(typeof(AvatarClip)), TrackBindingType(typeof(AvatarRenderer))]
    public sealed class AvatarTrack : TrackAsset
    {
        public override Playable CreateTrackMixer(PlayableGraph graph, GameObject go, int inputCount)
        {
            return ScriptPlayable<AvatarMixer>.Create(graph, inputCount);
        }
    }
}
