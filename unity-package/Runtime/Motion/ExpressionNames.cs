using System;
using System.Collections.Generic;
using System.Text;
using System.Text.RegularExpressions;

namespace Mua.Motion
{
    /// <summary>
    /// Which expressions of an avatar those of a mesh or a tracker move, and how much. Reference:
    /// python/mua/pose/expression_names.py.
    /// </summary>
    public static class ExpressionNames
    {
        private const float Deviations = 5; // of SMPL-X's training faces, at weight 1

        private static readonly Regex Word = new Regex(
            @"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|[\p{L}\p{Nl}\p{No}\p{Cs}-[A-Za-z]]+", RegexOptions.CultureInvariant);

        private static readonly Regex Coefficient = new Regex(@"^(?:.*\.)?(Exp[0-9]{3})\z", RegexOptions.CultureInvariant);

        private static readonly string[] Sides = { "left", "right" }, SideWords = { "Left", "Right" };
        private static readonly HashSet<string> Sided = InArkitOrPaired();
        private static readonly Dictionary<string, string> BySpelling = Spelt();
        private static readonly Dictionary<string, string> ByOtherName = OtherNames();

        /// <summary>The expression of a vocabulary that a name means, in whatever spelling; else null.</summary>
        public static string Known(string name)
        {
            string spelling = Spelling(name);
            if (BySpelling.TryGetValue(spelling, out string known) || ByOtherName.TryGetValue(spelling, out known))
            {
                return known;
            }
            foreach (string side in Sides)
            {
                if (spelling.EndsWith(side, StringComparison.Ordinal) &&
                    ByOtherName.TryGetValue(spelling.Substring(0, spelling.Length - side.Length), out string both))
                {
                    return BySpelling.TryGetValue(Spelling(both + "_" + side), out known) ? known : null;
                }
            }
            return null;
        }

        /// <summary>
        /// The expressions of a blend shape, each with the blend shape's value at weight 1: two for a coefficient of SMPL-X, which
        /// has either sign. Reference: python/mua/pose/signed_expressions.py.
        /// </summary>
        public static KeyValuePair<string, float>[] OfShape(string name)
        {
            string coefficient = Coefficient.Match(name).Groups[1].Value; // empty where it is none
            return coefficient.Length > 0
                ? new[]
                {
                    new KeyValuePair<string, float>(coefficient + "+", Deviations),
                    new KeyValuePair<string, float>(coefficient + "-", -Deviations),
                }
                : new[] { new KeyValuePair<string, float>(name, 1) };
        }

        /// <summary>
        /// How much [E, S] each expression of a source moves each of an avatar: 1 for the same, shares where another stands for
        /// it. The avatar's weights are sums that are held to 0 to 1.
        /// </summary>
        public static float[,] Match(IReadOnlyList<string> avatar, IReadOnlyList<string> source)
        {
            var shares = new float[avatar.Count, source.Count];
            Dictionary<string, int> rows = Rows(avatar);
            int[] direct = Direct(avatar, source, rows);
            var own = new HashSet<int>(direct);
            var ranks = new int[avatar.Count]; // vocabulary that an expression follows, plus 1
            for (int column = 0; column < source.Count; column++)
            {
                if (direct[column] >= 0)
                {
                    shares[direct[column], column] = 1;
                    continue;
                }
                string known = Known(source[column]);
                foreach (KeyValuePair<string, float> share in Nearest(known, rows))
                {
                    int row = rows[share.Key], rank = Rank(known) + 1;
                    if (own.Contains(row) || (ranks[row] != 0 && ranks[row] < rank))
                    {
                        continue;
                    }
                    for (int other = 0; rank < ranks[row] && other < column; other++)
                    {
                        shares[row, other] = 0;
                    }
                    ranks[row] = rank;
                    shares[row, column] = share.Value;
                }
            }
            return shares;
        }

        /// <summary>The row that each name of a source moves by itself; -1 where it moves none.</summary>
        private static int[] Direct(IReadOnlyList<string> avatar, IReadOnlyList<string> source, Dictionary<string, int> rows)
        {
            var direct = new int[source.Count];
            for (int column = 0; column < direct.Length; column++)
            {
                direct[column] = -1;
                for (int row = avatar.Count - 1; row >= 0; row--)
                {
                    direct[column] = avatar[row] == source[column] ? row : direct[column];
                }
                string known = direct[column] < 0 ? Known(source[column]) : null;
                if (known != null && rows.TryGetValue(known, out int same))
                {
                    direct[column] = same;
                }
            }
            return direct;
        }

        /// <summary>The row of each known expression: of several names for it, that of the nearest.</summary>
        private static Dictionary<string, int> Rows(IReadOnlyList<string> avatar)
        {
            var rows = new Dictionary<string, int>();
            for (int likeness = 0; likeness < 4; likeness++)
            {
                for (int row = 0; row < avatar.Count; row++)
                {
                    string known = Likeness(avatar[row]) == likeness ? Known(avatar[row]) : null;
                    if (known != null && !rows.ContainsKey(known))
                    {
                        rows.Add(known, row);
                    }
                }
            }
            return rows;
        }

        /// <summary>0 for another spelling of an expression's name, 2 for one with the same meaning; 1 more for a number.</summary>
        private static int Likeness(string name)
        {
            bool isNumbered = false;
            for (int i = name.LastIndexOf('.') + 1; i < name.Length; i++)
            {
                isNumbered |= char.IsDigit(name, i);
            }
            return (BySpelling.ContainsKey(Spelling(name)) ? 0 : 2) + (isNumbered ? 1 : 0);
        }

        /// <summary>What an avatar has of the first set that stands for an expression.</summary>
        private static List<KeyValuePair<string, float>> Nearest(string known, Dictionary<string, int> rows)
        {
            var there = new List<KeyValuePair<string, float>>();
            foreach (Dictionary<string, float> set in known == null ? new List<Dictionary<string, float>>() : StandIns(known))
            {
                foreach (KeyValuePair<string, float> share in set)
                {
                    if (rows.ContainsKey(share.Key))
                    {
                        there.Add(share);
                    }
                }
                if (there.Count > 0)
                {
                    break;
                }
            }
            return there;
        }

        /// <summary>
        /// Sets that stand for an expression. Of ARKit's, their pairs and halves, both sides stand for both as one, and half of
        /// that for a side, before others.
        /// </summary>
        private static List<Dictionary<string, float>> StandIns(string known)
        {
            string side = Array.Find(SideWords, word => known.EndsWith(word, StringComparison.Ordinal)) ?? "";
            var sets = new List<Dictionary<string, float>>
            {
                new Dictionary<string, float> { { known + SideWords[0], 1 }, { known + SideWords[1], 1 } },
                new Dictionary<string, float> { { known.Substring(0, known.Length - side.Length), 0.5f } },
            };
            sets.RemoveAll(sided => !Sided.IsSupersetOf(sided.Keys));
            if (ExpressionTable.StandIns.TryGetValue(known, out Dictionary<string, float>[] others))
            {
                sets.AddRange(others);
            }
            return sets;
        }

        private static int Rank(string known)
        {
            return Array.FindIndex(ExpressionTable.Vocabularies, names => Array.IndexOf(names, known) >= 0);
        }

        /// <summary>A name in one spelling, less words before it that only say whose it is; its side comes last.</summary>
        private static string Spelling(string name)
        {
            string own = name.Normalize(NormalizationForm.FormKC);
            var words = new List<string>();
            foreach (Match word in Word.Matches(own.Substring(own.LastIndexOf('.') + 1)))
            {
                words.Add(word.Value.ToLowerInvariant());
            }
            while (words.Count > 1 && Array.IndexOf(ExpressionTable.Owners, words[0]) >= 0)
            {
                words.RemoveAt(0);
            }
            if (words.Count > 1 && Side(words[0]) != null)
            {
                words.Add(words[0]);
                words.RemoveAt(0);
            }
            if (words.Count > 1)
            {
                words[words.Count - 1] = Side(words[words.Count - 1]) ?? words[words.Count - 1];
            }
            return string.Concat(words);
        }

        private static string Side(string word)
        {
            return Array.Find(Sides, side => word == side || word == side.Substring(0, 1));
        }

        private static HashSet<string> InArkitOrPaired()
        {
            var sided = new HashSet<string>(ExpressionTable.Vocabularies[2]);
            sided.UnionWith(ExpressionTable.Vocabularies[3]);
            return sided;
        }

        private static Dictionary<string, string> Spelt()
        {
            var found = new Dictionary<string, string>();
            foreach (string[] vocabulary in ExpressionTable.Vocabularies)
            {
                foreach (string name in vocabulary)
                {
                    found[Spelling(name)] = name;
                }
            }
            return found;
        }

        private static Dictionary<string, string> OtherNames()
        {
            var found = new Dictionary<string, string>();
            foreach (KeyValuePair<string, string> pair in ExpressionTable.OtherNames)
            {
                found[Spelling(pair.Key)] = pair.Value;
            }
            return found;
        }
    }
}
