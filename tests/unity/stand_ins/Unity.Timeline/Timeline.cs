// Stand-in. Source: com.unity.timeline 1.8, scripting reference.
using System;
using UnityEngine.Playables;

namespace UnityEngine.Timeline
{
    [Flags]
    public enum ClipCaps { None = 0, Looping = 1 << 0, Extrapolation = 1 << 1, ClipIn = 1 << 2, SpeedMultiplier = 1 << 3, Blending = 1 << 4 }

    public interface ITimelineClipAsset { ClipCaps clipCaps { get; } }

    public abstract class TrackAsset : PlayableAsset
    {
        public virtual Playable CreateTrackMixer(PlayableGraph graph, GameObject go, int inputCount) { return default(Playable); }
        public sealed override Playable CreatePlayable(PlayableGraph graph, GameObject go) { return default(Playable); }
    }

    [AttributeUsage(AttributeTargets.Class)] public class TrackColorAttribute : Attribute { public TrackColorAttribute(float r, float g, float b) { } }
    [AttributeUsage(AttributeTargets.Class, AllowMultiple = true)] public class TrackClipTypeAttribute : Attribute { public TrackClipTypeAttribute(Type clipClass) { } }
    [AttributeUsage(AttributeTargets.Class)] public class TrackBindingTypeAttribute : Attribute { public TrackBindingTypeAttribute(Type type) { } }
}
