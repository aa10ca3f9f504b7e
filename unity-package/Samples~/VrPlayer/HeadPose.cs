using UnityEngine;
using UnityEngine.XR;

namespace Mua.Samples.VrPlayer
{
    /// <summary>Keeps its camera where the headset is, once for the scripts and once more just before it draws.</summary>
    [DefaultExecutionOrder(-1000)]
    internal sealed class HeadPose : MonoBehaviour
    {
        /// <summary>Whether a headset gives the pose.</summary>
        public bool IsTracked { get; private set; }

        private void OnEnable()
        {
            Application.onBeforeRender += Track;
        }

        private void OnDisable()
        {
            Application.onBeforeRender -= Track;
        }

        private void Update()
        {
            Track();
        }

        private void Track()
        {
            InputDevice headset = InputDevices.GetDeviceAtXRNode(XRNode.Head);
            IsTracked = headset.TryGetFeatureValue(CommonUsages.centerEyePosition, out Vector3 position)
                & headset.TryGetFeatureValue(CommonUsages.centerEyeRotation, out Quaternion rotation);
            if (IsTracked)
            {
                transform.SetLocalPositionAndRotation(position, rotation);
            }
        }
    }
}
