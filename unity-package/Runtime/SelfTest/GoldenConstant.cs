using System;

namespace Mua.SelfTest
{
    /// <summary>A constant of a golden case; names of fields are those of the file.</summary>
    [Serializable]
    internal sealed class GoldenConstant
    {
        public string name = "";
        public string scalar = "";
        public int[] shape = new int[0];
        public double[] values = new double[0];

        /// <summary>Whether SelfTest can set it.</summary>
        public bool IsKnown()
        {
            switch (scalar + " " + shape.Length)
            {
                case "uint 0":
                case "float 0":
                    return values.Length == 1;
                case "uint 1":
                case "float 1":
                    return values.Length == shape[0] && shape[0] >= 2 && shape[0] <= 4;
                case "float 3":
                    return shape[1] == 4 && shape[2] == 4 && values.Length > 0 && values.Length == shape[0] * 16L;
                default:
                    return false;
            }
        }
    }
}
