using System;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// One or two eyes as the kernels take them: right-handed world to eye, and the projection before the graphics API's
    /// flip of rows and depth; SplatProject counts rows from the top itself.
    /// </summary>
    internal sealed class AvatarEyes
    {
        public const int Most = 2;

        /// <summary>How far splats may lie outside the box of their pose, in its diagonals; SplatProject keys their depth so far.</summary>
        public const float SplatReach = 0.5f;

        /// <summary>How far its shadow may, if the light comes from 20 degrees above the ground or more.</summary>
        public const float ShadowReach = 2;

        private const int Corners = 8; // of a box

        /// <summary>World to eye; a single eye stands in both places.</summary>
        public readonly Matrix4x4[] View = new Matrix4x4[Most];

        /// <summary>Eye to clip, -w to w in depth, as of Camera.projectionMatrix.</summary>
        public readonly Matrix4x4[] Projection = new Matrix4x4[Most];

        /// <summary>World to clip space with y up and this device's depth; Shaders/target.hlsl turns y where Unity does.</summary>
        public readonly Matrix4x4[] DeviceViewProjection = new Matrix4x4[Most];

        /// <summary>In the right-handed world, metres.</summary>
        public readonly Vector4[] Positions = new Vector4[Most];

        /// <summary>Width and height of one eye, pixels.</summary>
        public readonly float[] Screen = new float[2];

        public int Count { get; private set; }

        /// <summary>Metres; what is nearer is not drawn.</summary>
        public float Near { get; private set; }

        /// <summary>Mean of the eyes' positions in the right-handed world, metres.</summary>
        public Vector4 Middle { get; private set; }

        /// <summary>Instances of the indirect draw: two if both eyes are drawn by instancing, since the engine does not multiply these.</summary>
        public int Instances { get; private set; }

        /// <summary>Starts anew with a screen of so many pixels; Add the eyes after it, from the left.</summary>
        public void Begin(int width, int height, float near, int instances = 1)
        {
            Screen[0] = width;
            Screen[1] = height;
            Near = near;
            Instances = instances;
            Count = 0;
            Middle = Vector4.zero;
        }

        /// <summary>An eye with Unity's own matrices: left-handed world to eye, and eye to clip before the API's flip.</summary>
        public void Add(Matrix4x4 unityView, Matrix4x4 projection)
        {
            Matrix4x4 view = AvatarSpace.View(unityView);
            Vector4 position = Position(view), sum = Count * Middle + position;
            Matrix4x4 device = GL.GetGPUProjectionMatrix(projection, false) * view;
            for (int eye = Count; eye < Most; eye++)
            {
                View[eye] = view;
                Projection[eye] = projection;
                DeviceViewProjection[eye] = device;
                Positions[eye] = position;
            }
            Count++;
            Middle = new Vector4(sum.x / Count, sum.y / Count, sum.z / Count, 1);
        }

        /// <summary>
        /// Whether any eye may see what reaches so many diagonals beyond a box in the right-handed world, metres: not all of it
        /// lies beyond one side of the eye's view.
        /// </summary>
        public bool Sees(Vector3 low, Vector3 high, float reach)
        {
            float spare = reach * (high - low).magnitude;
            var margin = new Vector3(spare, spare, spare);
            for (int eye = 0; eye < Count; eye++)
            {
                if (Sees(Projection[eye] * View[eye], low - margin, high + margin))
                {
                    return true;
                }
            }
            return false;
        }

        /// <summary>Pixels of a square whose side is the diagonal of a box, as far away as the box's middle.</summary>
        public double Covered(Vector3 low, Vector3 high)
        {
            var eye = new Vector3(Middle.x, Middle.y, Middle.z);
            double focal = Projection[0].m11 * Screen[1] / 2, away = ((low + high) / 2 - eye).magnitude;
            double side = (high - low).magnitude * focal / Math.Max(away, Near);
            return side * side;
        }

        private static bool Sees(in Matrix4x4 viewProjection, Vector3 low, Vector3 high)
        {
            bool left = true, right = true, below = true, above = true, before = true;
            for (int corner = 0; corner < Corners; corner++)
            {
                Vector4 clip = viewProjection * new Vector4(
                    (corner & 1) == 0 ? low.x : high.x, (corner & 2) == 0 ? low.y : high.y,
                    (corner & 4) == 0 ? low.z : high.z, 1);
                left &= clip.x < -clip.w;
                right &= clip.x > clip.w;
                below &= clip.y < -clip.w;
                above &= clip.y > clip.w;
                before &= clip.z < -clip.w;
            }
            return !(left || right || below || above || before);
        }

        /// <summary>-R^T t of a rigid view.</summary>
        private static Vector4 Position(Matrix4x4 view)
        {
            return new Vector4(
                -(view.m00 * view.m03 + view.m10 * view.m13 + view.m20 * view.m23),
                -(view.m01 * view.m03 + view.m11 * view.m13 + view.m21 * view.m23),
                -(view.m02 * view.m03 + view.m12 * view.m13 + view.m22 * view.m23), 1);
        }
    }
}
