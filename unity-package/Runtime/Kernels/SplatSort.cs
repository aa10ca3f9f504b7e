using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>One pass of the radix sort: ComputeShaders/splat_sort.compute.</summary>
    internal sealed class SplatSort
    {
        /// <summary>Keys of a group.</summary>
        public const int Sorted = 2048;

        /// <summary>Values of a digit of 8 bits.</summary>
        public const int Digits = 256;

        /// <summary>Digits of a group of ScanDigits.</summary>
        private const int Scanned = 16;

        private const string File = "splat_sort.compute";

        private static readonly int Keys = Shader.PropertyToID("keys");
        private static readonly int Arguments = Shader.PropertyToID("arguments");
        private static readonly int DigitCounts = Shader.PropertyToID("digit_counts");
        private static readonly int DigitTotals = Shader.PropertyToID("digit_totals");
        private static readonly int SortedElements = Shader.PropertyToID("sorted");
        private static readonly int SecondPass = Shader.PropertyToID("second_pass");
        private static readonly int KeyCount = Shader.PropertyToID("key_count");
        private static readonly int Instances = Shader.PropertyToID("instances");
        private static readonly int Corners = Shader.PropertyToID("corners");

        private readonly Kernel countDigits;
        private readonly Kernel scanDigits;
        private readonly Kernel scatterDigits;

        public SplatSort(ComputeShader shader)
        {
            countDigits = new Kernel(shader, File, "CountDigits");
            scanDigits = new Kernel(shader, File, "ScanDigits");
            scatterDigits = new Kernel(shader, File, "ScatterDigits");
        }

        public void Count(CommandBuffer commands, SplatFrame frame, GraphicsBuffer keys, int secondPass)
        {
            countDigits.Set(commands, Keys, keys);
            countDigits.Set(commands, Arguments, frame.Arguments);
            countDigits.Set(commands, DigitCounts, frame.DigitCounts);
            countDigits.Set(commands, SecondPass, secondPass);
            countDigits.Set(commands, KeyCount, frame.SplatCount);
            countDigits.Dispatch(commands, Kernel.Groups(frame.SplatCount, Sorted), 1, 1);
        }

        public void Scan(CommandBuffer commands, SplatFrame frame, int secondPass)
        {
            scanDigits.Set(commands, Arguments, frame.Arguments);
            scanDigits.Set(commands, DigitCounts, frame.DigitCounts);
            scanDigits.Set(commands, DigitTotals, frame.DigitTotals);
            scanDigits.Set(commands, SecondPass, secondPass);
            scanDigits.Set(commands, KeyCount, frame.SplatCount);
            scanDigits.Dispatch(commands, Digits / Scanned, 1, 1);
        }

        /// <summary>The first pass also writes the arguments of a draw of `instances`.</summary>
        public void Scatter(
            CommandBuffer commands, SplatFrame frame, GraphicsBuffer keys, GraphicsBuffer sorted, int secondPass,
            int instances)
        {
            scatterDigits.Set(commands, Keys, keys);
            scatterDigits.Set(commands, Arguments, frame.Arguments);
            scatterDigits.Set(commands, DigitCounts, frame.DigitCounts);
            scatterDigits.Set(commands, DigitTotals, frame.DigitTotals);
            scatterDigits.Set(commands, SortedElements, sorted);
            scatterDigits.Set(commands, SecondPass, secondPass);
            scatterDigits.Set(commands, KeyCount, frame.SplatCount);
            scatterDigits.Set(commands, Instances, instances);
            scatterDigits.Set(commands, Corners, frame.Corners);
            scatterDigits.Dispatch(commands, Kernel.Groups(frame.SplatCount, Sorted), 1, 1);
        }
    }
}
