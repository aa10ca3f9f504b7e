using UnityEngine.XR;

namespace Mua.Samples.VrPlayer
{
    /// <summary>A button of a controller and what it does.</summary>
    internal readonly struct HeadsetButton
    {
        public readonly XRNode Hand;
        public readonly InputFeatureUsage<bool> Usage;
        public readonly PlayerAction Plain;

        /// <summary>What it does while the left grip is held.</summary>
        public readonly PlayerAction Shifted;

        public HeadsetButton(XRNode hand, InputFeatureUsage<bool> usage, PlayerAction plain, PlayerAction shifted)
        {
            Hand = hand;
            Usage = usage;
            Plain = plain;
            Shifted = shifted;
        }
    }
}
