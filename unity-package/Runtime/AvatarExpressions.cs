using System;
using System.Collections.Generic;
using Mua.Format;
using Mua.Motion;

namespace Mua
{
    /// <summary>Weights of an avatar's expressions that were set, whatever else moves it; the others are those of its clip.</summary>
    internal sealed class AvatarExpressions
    {
        /// <summary>Those of no avatar.</summary>
        public static readonly AvatarExpressions None = new AvatarExpressions(new string[0]);

        private readonly string[] names;
        private readonly float[] set; // [E] NaN where none was
        private readonly float[] taken; // [E] as they were at the last Take
        private readonly List<string> asked = new List<string>(); // by the application, in whatever vocabulary
        private readonly List<float> weights = new List<float>(); // of those
        private ExpressionMapping mapping; // from those

        public AvatarExpressions(AvatarFile avatar)
            : this(avatar.Expressions == null ? new string[0] : avatar.Expressions.Names)
        {
        }

        private AvatarExpressions(string[] names)
        {
            this.names = names;
            set = new float[names.Length];
            taken = new float[names.Length];
            Reset();
            set.CopyTo(taken, 0);
        }

        /// <summary>[E]</summary>
        public IReadOnlyList<string> Names => names;

        /// <summary>Whether weights were set to others since the last Take.</summary>
        public bool HasChanged
        {
            get
            {
                for (int i = 0; i < set.Length; i++)
                {
                    if (!set[i].Equals(taken[i]))
                    {
                        return true;
                    }
                }
                return false;
            }
        }

        /// <summary>Its place among the names, or a negative number.</summary>
        public int Find(string name)
        {
            return Array.IndexOf(names, name);
        }

        /// <summary>The weight that was set, NaN where none was.</summary>
        public float Get(int index)
        {
            return set[index];
        }

        /// <summary>Sets a weight, held to 0 to 1; NaN gives the expression back to the clip.</summary>
        public void Set(int index, float weight)
        {
            set[index] = float.IsNaN(weight) ? weight : Math.Min(Math.Max(weight, 0), 1);
        }

        /// <summary>
        /// Sets a weight by the avatar's name for an expression, or by that of another which it stands for; whether anything
        /// follows.
        /// </summary>
        public bool Set(string name, float weight)
        {
            int at = asked.IndexOf(name);
            if (at < 0)
            {
                if (names.Length == 0 || name == null || (Find(name) < 0 && ExpressionNames.Known(name) == null))
                {
                    return false;
                }
                at = asked.Count;
                asked.Add(name);
                weights.Add(weight);
                mapping = new ExpressionMapping(this, asked);
            }
            weights[at] = weight;
            mapping.Apply(at, weights);
            return mapping.Moves(at);
        }

        /// <summary>Gives all expressions back to the clip.</summary>
        public void Reset()
        {
            asked.Clear();
            weights.Clear();
            for (int i = 0; i < set.Length; i++)
            {
                set[i] = float.NaN;
            }
        }

        /// <summary>Puts the weights that were set in the place of a clip's [E].</summary>
        public void Take(Span<float> weights)
        {
            set.CopyTo(taken, 0);
            for (int i = 0; i < set.Length; i++)
            {
                weights[i] = float.IsNaN(set[i]) ? weights[i] : set[i];
            }
        }
    }
}
