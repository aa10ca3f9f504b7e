using System;
using UnityEngine;

namespace Mua
{
    /// <summary>Which cameras one avatar is drawn for, and how large it looks to them.</summary>
    internal sealed class AvatarSight
    {
        private readonly AvatarRenderer owner;
        private readonly AvatarFrame decoded;
        private readonly AvatarBuffers buffers;
        private Camera neededBy; // the last camera whose image it is in
        private int neededFrame = -2; // displayed frame of that

        public AvatarSight(AvatarRenderer owner, AvatarFrame decoded, AvatarBuffers buffers)
        {
            this.owner = owner;
            this.decoded = decoded;
            this.buffers = buffers;
        }

        /// <summary>
        /// Whether a camera draws its layer, and in the editor what its scene belongs to: the scene view shows an opened prefab
        /// alone, the game view never shows it, and what the Hierarchy hides is hidden in scene views.
        /// </summary>
        public bool IsShownTo(Camera camera)
        {
            bool isOnLayer = (camera.cullingMask & (1 << owner.gameObject.layer)) != 0;
#if UNITY_EDITOR
            bool isHidden = camera.cameraType == CameraType.SceneView
                && UnityEditor.SceneVisibilityManager.instance.IsHidden(owner.gameObject);
            return isOnLayer && !isHidden
                && UnityEditor.SceneManagement.StageUtility.IsGameObjectRenderedByCamera(owner.gameObject, camera);
#else
            return isOnLayer;
#endif
        }

        /// <summary>Whether it is drawn for these eyes of the camera that is recorded.</summary>
        public bool IsSeenBy(AvatarEyes eyes)
        {
            return decoded.IsShown && eyes.Sees(decoded.Low, decoded.High, AvatarEyes.SplatReach);
        }

        /// <summary>Whether it, or the shadow that it casts, may be drawn for these eyes.</summary>
        public bool IsNeededFor(AvatarEyes eyes)
        {
            bool hasShadow = (owner.Views & AvatarViews.Shadow) != 0;
            float reach = hasShadow ? AvatarEyes.ShadowReach : AvatarEyes.SplatReach;
            return decoded.IsShown && eyes.Sees(decoded.Low, decoded.High, reach);
        }

        /// <summary>
        /// Whether this camera needs it now, or another one did in this displayed frame or the last.
        /// </summary>
        public bool IsNeeded(Camera camera, AvatarEyes eyes)
        {
            bool isNow = IsNeededFor(eyes);
            if (isNow)
            {
                neededBy = camera;
                neededFrame = Time.frameCount;
            }
            return isNow || (!ReferenceEquals(neededBy, camera) && neededFrame >= Time.frameCount - 1);
        }

        /// <summary>How near the eyes are to it, and how large a texel at the nearest point of its box looks to them.</summary>
        public AvatarSeen Seen(AvatarEyes eyes)
        {
            var eye = new Vector3(eyes.Middle.x, eyes.Middle.y, eyes.Middle.z);
            Vector3 aside = Vector3.Max(Vector3.Max(decoded.Low - eye, eye - decoded.High), Vector3.zero);
            double distance = aside.magnitude, focal = Math.Abs(eyes.Projection[0].m11) * eyes.Screen[1] / 2;
            double metre = focal / Math.Max(distance, eyes.Near);
            return new AvatarSeen
            {
                Distance = distance,
                Texel = decoded.Size * buffers.TexelLength * metre,
                Height = (decoded.High.y - decoded.Low.y) * metre,
                Counts = buffers.SplatCounts,
            };
        }
    }
}
