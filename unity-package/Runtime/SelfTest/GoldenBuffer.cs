using System;

namespace Mua.SelfTest
{
    /// <summary>What a buffer holds before the dispatch; names of fields are those of the file.</summary>
    [Serializable]
    internal sealed class GoldenBuffer
    {
        public string name = "";
        public string element = "";
        public int count = 0;
        public int offset = 0;

        /// <summary>Of one element, in 4 bytes each; 0 where the type is not known.</summary>
        public int Words
        {
            get
            {
                switch (element)
                {
                    case "uint":
                    case "float":
                        return 1;
                    case "uint2":
                    case "float2":
                        return 2;
                    case "uint4":
                    case "float4":
                        return 4;
                    default:
                        return 0;
                }
            }
        }
    }
}
