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

        private const string File = "splat_sort.compute";
        private const uint SortArguments = 16; // byte of `arguments` at which the group counts of the sort stand

        private static readonly int Keys = Shader.PropertyToID("keys");
        private static readonly int Values = Shader.PropertyToID("values");
        private static readonly int Arguments = Shader.PropertyToID("arguments");
        private static readonly int DigitCounts = Shader.PropertyToID("digit_counts");
        private static readonly int DigitTotals = Shader.PropertyToID("digit_totals");
        private static readonly int SortedKeys = Shader.PropertyToID("sorted_keys");
        private static readonly int SortedValues = Shader.PropertyToID("sorted_values");
        private static readonly int Shift = Shader.PropertyToID("shift");

        private readonly Kernel countDigits;
        private readonly Kernel scanDigits;
        private readonly Kernel scatterDigits;

        public SplatSort(ComputeShader shader)
        {
            countDigits = new Kernel(shader, File, "CountDigits");
            scanDigits = new Kernel(shader, File, "ScanDigits");
            scatterDigits = new Kernel(shader, File, "ScatterDigits");
        }

        public void Count(CommandBuffer commands, SplatFrame frame, GraphicsBuffer keys, int shift)
        {
            countDigits.Set(commands, Keys, keys);
            countDigits.Set(commands, Arguments, frame.Arguments);
            countDigits.Set(commands, DigitCounts, frame.DigitCounts);
            countDigits.Set(commands, Shift, shift);
            countDigits.DispatchIndirect(commands, frame.IndirectArguments, SortArguments);
        }

        public void Scan(CommandBuffer commands, SplatFrame frame)
        {
            scanDigits.Set(commands, Arguments, frame.Arguments);
            scanDigits.Set(commands, DigitCounts, frame.DigitCounts);
            scanDigits.Set(commands, DigitTotals, frame.DigitTotals);
            scanDigits.Dispatch(commands, Digits, 1, 1);
        }

        public void Scatter(
            CommandBuffer commands, SplatFrame frame, GraphicsBuffer keys, GraphicsBuffer values,
            GraphicsBuffer sortedKeys, GraphicsBuffer sortedValues, int shift)
        {
            scatterDigits.Set(commands, Keys, keys);
            scatterDigits.Set(commands, Values, values);
            scatterDigits.Set(commands, Arguments, frame.Arguments);
            scatterDigits.Set(commands, DigitCounts, frame.DigitCounts);
            scatterDigits.Set(commands, DigitTotals, frame.DigitTotals);
            scatterDigits.Set(commands, SortedKeys, sortedKeys);
            scatterDigits.Set(commands, SortedValues, sortedValues);
            scatterDigits.Set(commands, Shift, shift);
            scatterDigits.DispatchIndirect(commands, frame.IndirectArguments, SortArguments);
        }
    }
}
