using System;

namespace Mua.Motion
{
    /// <summary>Which expressions hold others back, and which are switches. Reference: python/mua/pose/expression_rules.py.</summary>
    public static class ExpressionRules
    {
        private const int Kinds = 3; // blinks, looks, mouths
        private const int Blocks = 1;
        private const int Blends = 2;
        private const int OfKind = 3;
        private const int Switch = 1 << 2 * Kinds;

        /// <summary>Leaves of the weights [E] what shows, as rules [E] hold them back, or all where there are no rules.</summary>
        public static void Apply(ReadOnlySpan<int> rules, Span<float> weights)
        {
            if (rules.IsEmpty)
            {
                return;
            }
            for (int e = 0; e < weights.Length; e++)
            {
                weights[e] = !IsSwitch(rules[e]) ? weights[e] : weights[e] > 0.5f ? 1 : 0;
            }
            Span<double> held = stackalloc double[Kinds];
            for (int kind = 0; kind < Kinds; kind++)
            {
                held[kind] = Held(rules, weights, kind);
            }
            for (int e = 0; e < weights.Length; e++)
            {
                weights[e] = Left(rules[e], weights[e], held);
            }
        }

        /// <summary>How much all of a kind is held back, 0 to 1.</summary>
        private static double Held(ReadOnlySpan<int> rules, ReadOnlySpan<float> weights, int kind)
        {
            double sum = 0;
            for (int e = 0; e < weights.Length; e++)
            {
                int role = Role(rules[e], kind);
                sum += role == Blends ? weights[e] : role == Blocks && weights[e] > 0 ? 1 : 0;
            }
            return Math.Min(sum, 1);
        }

        private static float Left(int rule, double weight, ReadOnlySpan<double> held)
        {
            for (int kind = 0; kind < Kinds; kind++)
            {
                if (Role(rule, kind) == OfKind)
                {
                    weight *= !IsSwitch(rule) ? 1 - held[kind] : held[kind] > 0 ? 0 : 1;
                }
            }
            return (float)weight;
        }

        private static bool IsSwitch(int rule)
        {
            return (rule & Switch) != 0;
        }

        private static int Role(int rule, int kind)
        {
            return rule >> 2 * kind & OfKind;
        }
    }
}
