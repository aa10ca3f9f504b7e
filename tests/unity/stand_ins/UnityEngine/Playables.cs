// Stand-in. Source: Unity 6000.0 scripting reference, UnityEngine.Playables.
using System;
using System.Collections.Generic;

namespace UnityEngine.Playables
{
    public interface IPlayable { PlayableHandle GetHandle(); }
    public interface IPlayableBehaviour { }
    public interface IPlayableAsset { }
    public struct PlayableGraph { }
    public struct FrameData { }

    /// <summary>What a playable of the engine is.</summary>
    public sealed class PlayableHandle
    {
        internal readonly List<PlayableHandle> Inputs = new List<PlayableHandle>();
        internal readonly List<float> Weights = new List<float>();
        internal object Behaviour;
        internal double Time;
    }

    public struct Playable : IPlayable
    {
        private readonly PlayableHandle handle;

        internal Playable(PlayableHandle handle) { this.handle = handle; }
        public PlayableHandle GetHandle() { return handle; }
    }

    public struct ScriptPlayable<T> : IPlayable where T : class, IPlayableBehaviour, new()
    {
        private readonly PlayableHandle handle;

        private ScriptPlayable(PlayableHandle handle) { this.handle = handle; }
        public static ScriptPlayable<T> Create(PlayableGraph graph, int inputCount = 0)
        {
            var made = new PlayableHandle { Behaviour = new T() };
            for (int i = 0; i < inputCount; i++)
            {
                made.Inputs.Add(null);
                made.Weights.Add(0);
            }
            return new ScriptPlayable<T>(made);
        }
        public PlayableHandle GetHandle() { return handle; }
        public T GetBehaviour() { return (T)handle.Behaviour; }
        public static implicit operator Playable(ScriptPlayable<T> playable) { return new Playable(playable.handle); }
        public static explicit operator ScriptPlayable<T>(Playable playable) { return new ScriptPlayable<T>(playable.GetHandle()); }
    }

    public abstract class PlayableBehaviour : IPlayableBehaviour
    {
        public virtual void OnPlayableDestroy(Playable playable) { }
        public virtual void ProcessFrame(Playable playable, FrameData info, object playerData) { }
    }

    public abstract class PlayableAsset : ScriptableObject, IPlayableAsset
    {
        public abstract Playable CreatePlayable(PlayableGraph graph, GameObject owner);
    }

    public static class PlayableExtensions
    {
        public static int GetInputCount<U>(this U playable) where U : struct, IPlayable { return playable.GetHandle().Inputs.Count; }
        public static Playable GetInput<U>(this U playable, int inputPort) where U : struct, IPlayable { return new Playable(playable.GetHandle().Inputs[inputPort]); }
        public static float GetInputWeight<U>(this U playable, int inputIndex) where U : struct, IPlayable { return playable.GetHandle().Weights[inputIndex]; }
        public static void SetInputWeight<U>(this U playable, int inputIndex, float weight) where U : struct, IPlayable { playable.GetHandle().Weights[inputIndex] = weight; }
        public static double GetTime<U>(this U playable) where U : struct, IPlayable { return playable.GetHandle().Time; }
        public static void SetTime<U>(this U playable, double value) where U : struct, IPlayable { playable.GetHandle().Time = value; }
        public static void ConnectInput<U, V>(this U playable, int inputIndex, V sourcePlayable, int sourceOutputIndex)
            where U : struct, IPlayable
            where V : struct, IPlayable
        {
            playable.GetHandle().Inputs[inputIndex] = sourcePlayable.GetHandle();
        }
    }
}
