using System;
using System.Collections.Generic;

namespace Mua.Format
{
    /// <summary>Expressions of a parsed tree and their weights in clips, checked as in python/mua/asset/read_rig.py and read.py.</summary>
    internal static class ExpressionDecoder
    {
        /// <summary>Null where the file holds none.</summary>
        public static Expressions Expressions(Table tree, int vertices, Tensors tensors)
        {
            if (tree == null)
            {
                return null;
            }
            string[] names = tree.Texts("names");
            RequireNames(names);
            Tensor starts = tensors.Indices(tree.Child("starts"), "expressions.starts", 0, int.MaxValue, names.Length + 1);
            RequireStarts(starts.Integers);
            int count = starts.Integers[names.Length];
            Tensor moved = tensors.Indices(tree.Child("vertices"), "expressions.vertices", 0, vertices, count);
            RequireAscending(moved.Integers, starts.Integers);
            Tensor offsets = tensors.Reals(tree.Child("offsets"), "expressions.offsets", count, 3);
            Table lit = tree.Child("gains");
            Tensor gains = lit == null ? null : tensors.Reals(lit, "expressions.gains", count);
            Table ruled = tree.Child("rules");
            Tensor rules = ruled == null
                ? null : tensors.Indices(ruled, "expressions.rules", 0, Limits.RuleCodes, names.Length);
            return new Expressions
            {
                Names = names, Starts = starts, Vertices = moved, Offsets = offsets, Gains = gains, Rules = rules,
            };
        }

        /// <summary>[F, E] of a clip; null where it has none.</summary>
        public static Tensor Weights(Table tree, string path, int frames, int expressions, Tensors tensors)
        {
            if (tree == null)
            {
                return null;
            }
            Tensor weights = tensors.Reals(tree, path, frames, expressions);
            for (int i = 0; i < weights.Count; i++)
            {
                float weight = weights.Read(i);
                if (weight < 0 || weight > 1)
                {
                    throw Refusal.Of(path, "a weight is not within 0 to 1");
                }
            }
            return weights;
        }

        private static void RequireNames(string[] names)
        {
            var found = new HashSet<string>(StringComparer.Ordinal);
            for (int i = 0; i < names.Length; i++)
            {
                if (names[i].Length == 0 || !found.Add(names[i]))
                {
                    throw Refusal.Of("expressions.names[" + i + "]", "'{0}' is empty or stands there twice", names[i]);
                }
            }
        }

        private static void RequireStarts(ReadOnlySpan<int> starts)
        {
            bool isSound = starts[0] == 0;
            for (int i = 1; i < starts.Length; i++)
            {
                isSound &= starts[i] >= starts[i - 1];
            }
            if (!isSound)
            {
                throw Refusal.Of("expressions.starts", "the starts must begin with 0 and never fall");
            }
        }

        private static void RequireAscending(ReadOnlySpan<int> vertices, ReadOnlySpan<int> starts)
        {
            for (int expression = 1; expression < starts.Length; expression++)
            {
                for (int i = starts[expression - 1] + 1; i < starts[expression]; i++)
                {
                    if (vertices[i] <= vertices[i - 1])
                    {
                        throw Refusal.Of("expressions.vertices", "vertices must ascend within an expression");
                    }
                }
            }
        }
    }
}
