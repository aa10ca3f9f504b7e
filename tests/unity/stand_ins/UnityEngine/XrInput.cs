// Stand-in. Source: Unity 6000.0, XRInput.bindings.cs, VRNode.cs; a test sets what the devices report.
using System.Collections.Generic;

namespace UnityEngine.XR
{
    public enum XRNode { LeftEye, RightEye, CenterEye, Head, LeftHand, RightHand, GameController, TrackingReference, HardwareTracker }

    public struct InputFeatureUsage<T>
    {
        public string name { get; set; }
        public InputFeatureUsage(string usageName) : this() { name = usageName; }
    }

    public static class CommonUsages
    {
        public static InputFeatureUsage<bool> primaryButton = new InputFeatureUsage<bool>("PrimaryButton");
        public static InputFeatureUsage<bool> secondaryButton = new InputFeatureUsage<bool>("SecondaryButton");
        public static InputFeatureUsage<bool> gripButton = new InputFeatureUsage<bool>("GripButton");
        public static InputFeatureUsage<bool> triggerButton = new InputFeatureUsage<bool>("TriggerButton");
        public static InputFeatureUsage<bool> menuButton = new InputFeatureUsage<bool>("MenuButton");
        public static InputFeatureUsage<bool> primary2DAxisClick = new InputFeatureUsage<bool>("Primary2DAxisClick");
        public static InputFeatureUsage<Vector2> primary2DAxis = new InputFeatureUsage<Vector2>("Primary2DAxis");
        public static InputFeatureUsage<Vector3> centerEyePosition = new InputFeatureUsage<Vector3>("CenterEyePosition");
        public static InputFeatureUsage<Quaternion> centerEyeRotation = new InputFeatureUsage<Quaternion>("CenterEyeRotation");
    }

    public struct InputDevice
    {
        internal Dictionary<string, object> Values;

        public bool TryGetFeatureValue(InputFeatureUsage<bool> usage, out bool value) { return Get(usage.name, out value); }
        public bool TryGetFeatureValue(InputFeatureUsage<float> usage, out float value) { return Get(usage.name, out value); }
        public bool TryGetFeatureValue(InputFeatureUsage<Vector2> usage, out Vector2 value) { return Get(usage.name, out value); }
        public bool TryGetFeatureValue(InputFeatureUsage<Vector3> usage, out Vector3 value) { return Get(usage.name, out value); }
        public bool TryGetFeatureValue(InputFeatureUsage<Quaternion> usage, out Quaternion value) { return Get(usage.name, out value); }

        private bool Get<T>(string usage, out T value)
        {
            object found = null;
            bool has = Values != null && Values.TryGetValue(usage, out found);
            value = has ? (T)found : default(T);
            return has;
        }
    }

    public static class InputDevices
    {
        public static InputDevice GetDeviceAtXRNode(XRNode node) { return new InputDevice { Values = StandIns.Devices.At(node) }; }
    }
}

namespace StandIns
{
    using UnityEngine.XR;

    /// <summary>What headset and controllers report; a device is there once it reports anything. Not part of Unity's API.</summary>
    public static class Devices
    {
        private static readonly Dictionary<string, object>[] Nodes = new Dictionary<string, object>[9];

        public static void Report<T>(XRNode node, InputFeatureUsage<T> usage, T value) { At(node)[usage.name] = value; }

        internal static Dictionary<string, object> At(XRNode node)
        {
            return Nodes[(int)node] ?? (Nodes[(int)node] = new Dictionary<string, object>());
        }
    }
}
