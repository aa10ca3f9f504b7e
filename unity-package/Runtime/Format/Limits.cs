// Generated from python/mua/limits.py by tools/gen_layout.py; do not edit.

namespace Mua.Format
{
    internal static class Limits
    {
        public const int Major = 1;
        public const int Minor = 2;
        public const int MaxRank = 4;
        public const double Largest = 65504.0;
        public const int UnpackedTimes = 16;
        public const int UnpackedRoom = 1048576;
        public const double LeastStep = 5.960464477539063e-08;
        public const double LargestStep = 1.0;
        public const int Stages = 5;
        public const int MaxJoints = 4096;
        public const int MaxLayers = 64;
        public const int MaxClips = 4096;
        public const int MaxExpressions = 1024;
        public const int RuleCodes = 128;
        public const int MaxLevels = 8;
        public const int MaxSide = 4096;
        public const int TextureTimes = 16;
        public const int TextureRoom = 65536;
        public const int MaxDetailLevels = 2;
        public const int MostTaps = 32;
        public const double Growth = 1.85;
        public const double UnitBound = 0.002;
        public const double WeightBound = 0.0001;
        public const double BindBound = 0.0001;
        public const double BarycentricSlack = 4.76837158203125e-07;
        public const int MaxInfluences = 8;
        public const int MaxTaps = 40;
        public const double LargestTap = 16.0;
        public const int MaxWindow = 16;
        public const double LeastRate = 1.0;
        public const double LargestRate = 1000.0;
        public const int MaxFrames = 1048576;
        public const int MaxAdded = 16777216;
        public const double LeastScale = 1e-06;
        public const double Magnitude = 4.611686018427388e+18;
    }
}
