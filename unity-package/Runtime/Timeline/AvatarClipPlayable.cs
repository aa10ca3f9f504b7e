using UnityEngine.Playables;

namespace Mua
{
    /// <summary>Which clip an input of an AvatarMixer plays; the input's time is the clip's.</summary>
    internal sealed class AvatarClipPlayable : PlayableBehaviour
    {
        public string Clip { get; set; } = "";
    }
}
