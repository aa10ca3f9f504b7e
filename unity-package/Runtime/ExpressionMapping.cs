using System.Collections.Generic;
using Mua.Motion;

namespace Mua
{
    /// <summary>Sets expressions of an avatar by the weights of others, whatever these are called.</summary>
    internal sealed class ExpressionMapping
    {
        private readonly AvatarExpressions expressions;
        private readonly int count; // S
        private readonly float[,] shares; // [E, S]

        /// <param name="source">[S] names</param>
        public ExpressionMapping(AvatarExpressions expressions, IReadOnlyList<string> source)
        {
            this.expressions = expressions;
            count = source.Count;
            shares = ExpressionNames.Match(expressions.Names, source);
        }

        /// <summary>Whether any expression of the avatar follows one of the source.</summary>
        public bool Moves(int column)
        {
            for (int row = 0; row < expressions.Names.Count; row++)
            {
                if (shares[row, column] != 0)
                {
                    return true;
                }
            }
            return false;
        }

        /// <summary>Sets what follows one of the source's expressions, by the weights of all [S].</summary>
        public void Apply(int column, IReadOnlyList<float> weights)
        {
            for (int row = 0; row < expressions.Names.Count; row++)
            {
                if (shares[row, column] != 0)
                {
                    expressions.Set(row, Sum(row, weights));
                }
            }
        }

        /// <summary>Sets all that follow, by the weights [S].</summary>
        public void Apply(IReadOnlyList<float> weights)
        {
            for (int row = 0; row < expressions.Names.Count; row++)
            {
                if (Follows(row))
                {
                    expressions.Set(row, Sum(row, weights));
                }
            }
        }

        /// <summary>Gives what follows back to the clip.</summary>
        public void Release()
        {
            for (int row = 0; row < expressions.Names.Count; row++)
            {
                if (Follows(row))
                {
                    expressions.Set(row, float.NaN);
                }
            }
        }

        private bool Follows(int row)
        {
            for (int column = 0; column < count; column++)
            {
                if (shares[row, column] != 0)
                {
                    return true;
                }
            }
            return false;
        }

        private float Sum(int row, IReadOnlyList<float> weights)
        {
            double sum = 0;
            for (int column = 0; column < count; column++)
            {
                sum += (double)shares[row, column] * weights[column];
            }
            return (float)sum;
        }
    }
}
