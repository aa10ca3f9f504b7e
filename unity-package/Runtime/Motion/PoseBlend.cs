using System;
using Mua.Format;

namespace Mua.Motion
{
    /// <summary>Poses between two poses.</summary>
    public static class PoseBlend
    {
        /// <summary>
        /// Moves a pose of local rotations [J, 4] and translations [J, 3] towards another, of which it takes the share `t` from
        /// 0 to 1.
        /// </summary>
        public static void Approach(
            Span<double> rotations, Span<double> translations, ReadOnlySpan<double> toRotations,
            ReadOnlySpan<double> toTranslations, double t)
        {
            for (int joint = 0; joint < rotations.Length / 4; joint++)
            {
                QuaternionD a = QuaternionD.Load(rotations, joint), b = QuaternionD.Load(toRotations, joint);
                QuaternionD.Slerp(a, b, t).Store(rotations, joint);
                Vector3D from = Vector3D.Load(translations, joint), to = Vector3D.Load(toTranslations, joint);
                Vector3D between = from + t * (to - from);
                between.Store(translations, joint);
            }
        }
    }
}
