using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using System.Text.RegularExpressions;

namespace Mua.Motion
{
    /// <summary>
    /// The role of a single joint by its name, whatever program named it (python/mua/pose/joint_names.py, whose words are
    /// JointWords).
    /// </summary>
    internal static class JointNames
    {
        public static readonly string[] Sides = { "left", "right" };
        public static readonly string[] Fingers = { "thumb", "index", "middle", "ring", "pinky" };
        public static readonly Regex Namespace = new Regex("^.*[:|]");

        private const int LimbsNamed = 6; // of Limbs, which names that are understood tell at least

        private static readonly string[] Limbs =
            Sides.SelectMany(side => new[] { "upper_arm", "forearm", "thigh", "shin" }.Select(part => side + " " + part)).ToArray();

        private static readonly Regex RigPrefix = new Regex(
            @"^(valvebiped\.)?((mixamorig[0-9]*|bip[0-9]+)[\s_.-]?"
            + @"|(cc_base|def|j_bip(_c)?|b|j|jnt|joint|character[0-9]*|quickrigcharacter[0-9]*|skeleton|armature)[\s_.-])",
            RegexOptions.IgnoreCase | RegexOptions.CultureInvariant);

        private static readonly Regex Word = new Regex("[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+");
        private static readonly Regex FbxEscape = new Regex("FBXASC([0-9]{3})"); // Maya writes other characters by their code
        private static readonly Regex Owner = new Regex(@"^[\p{L}\p{N}]+[_\s.-]+"); // the word before a joint's own name
        private static readonly Regex LastWord = new Regex("([A-Z][a-z]*|[a-z]+)$");

        private static readonly Regex NumberedFinger =
            new Regex(@"finger[\s_.-]?([0-9])", RegexOptions.IgnoreCase | RegexOptions.CultureInvariant);

        /// <summary>The role of each joint by its name alone; null where it tells none.</summary>
        public static string[] Roles(string[] names)
        {
            string[] bare = WithoutOwner(names);
            int first = FirstFinger(bare);
            return bare.Select(name => Role(name, first)).ToArray();
        }

        /// <summary>The names less the figure's own before them, as in UnityChan_LeftArm, where they tell limbs only without.</summary>
        private static string[] WithoutOwner(string[] names)
        {
            IEnumerable<string> starts = names.Select(name => Owner.Match(name).Value).Where(start => start.Length > 0)
                .GroupBy(start => start).OrderByDescending(group => group.Count()).Take(2).Select(group => group.Key);
            string common = Common(names);
            foreach (string owner in new[] { "", common, LastWord.Replace(common, "") }.Concat(starts))
            {
                string[] bare = names.Select(name => Less(name, owner)).ToArray();
                int first = FirstFinger(bare);
                if (bare.Select(name => Role(name, first)).Distinct().Count(role => Limbs.Contains(role)) >= LimbsNamed)
                {
                    return bare;
                }
            }
            return names;
        }

        private static string Common(string[] names)
        {
            string start = names[0];
            foreach (string name in names)
            {
                int shared = 0;
                while (shared < start.Length && shared < name.Length && start[shared] == name[shared])
                {
                    shared++;
                }
                start = start.Substring(0, shared);
            }
            return start;
        }

        private static string Less(string name, string owner)
        {
            return name.Length > owner.Length && name.StartsWith(owner, StringComparison.Ordinal)
                ? name.Substring(owner.Length)
                : name;
        }

        private static string Role(string filed, int firstFinger)
        {
            string name = WithoutAccents(FbxEscape.Replace(filed, code => ((char)int.Parse(code.Groups[1].Value)).ToString()));
            if (!IsAscii(name))
            {
                return WideRole(name);
            }
            string bare = RigPrefix.Replace(Namespace.Replace(name, ""), "");
            string[] words = Word.Matches(bare).Cast<Match>().Select(word => word.Value.ToLowerInvariant()).ToArray();
            Dictionary<string, string> known = words.Any(JointWords.Side.ContainsKey) ? JointWords.Side : JointWords.ForeignSide;
            List<string> sides = words.Where(known.ContainsKey).Select(word => known[word]).ToList();
            string[] kept = words.Where(word => !known.ContainsKey(word) && !JointWords.NoPart.Contains(word)).ToArray();
            string part = string.Concat(kept), backward = string.Concat(kept.Reverse()); // armUpper
            FindSide(sides, ref part);
            if (sides.Count != 1)
            {
                return sides.Count > 0 ? null : Find(JointWords.Central, part) ?? Find(JointWords.Central, backward);
            }
            Match numbered = NumberedFinger.Match(bare);
            string found = numbered.Success
                ? Fingers.ElementAtOrDefault(int.Parse(numbered.Groups[1].Value) - firstFinger)
                : Find(JointWords.Sided, part) ?? Find(JointWords.Sided, backward);
            return found == null ? null : sides[0] + " " + found;
        }

        /// <summary>The side that is no word of its own: leftarm, lhumerus, rfoot.</summary>
        private static void FindSide(List<string> sides, ref string part)
        {
            foreach (string side in Sides)
            {
                bool begins = part.StartsWith(side, StringComparison.Ordinal), ends = part.EndsWith(side, StringComparison.Ordinal);
                if (sides.Count == 0 && !JointWords.Central.ContainsKey(part) && (begins || ends))
                {
                    sides.Add(side);
                    part = begins ? part.Substring(side.Length) : part;
                    part = part.EndsWith(side, StringComparison.Ordinal) ? part.Substring(0, part.Length - side.Length) : part;
                }
            }
            if (sides.Count == 0 && part.Length > 0 && JointWords.Side.ContainsKey(part.Substring(0, 1))
                && JointWords.Sided.ContainsKey(part.Substring(1)))
            {
                sides.Add(JointWords.Side[part.Substring(0, 1)]);
                part = part.Substring(1);
            }
        }

        /// <summary>The name in ASCII where only accents and the German ß are not.</summary>
        private static string WithoutAccents(string name)
        {
            if (IsAscii(name))
            {
                return name;
            }
            string apart = name.Replace("ß", "ss").Normalize(NormalizationForm.FormKD);
            string plain = string.Concat(apart.Where(IsAscii));
            return plain.Length >= name.Count(letter => !char.IsLowSurrogate(letter)) ? plain : name;
        }

        /// <summary>The role of a Chinese or Japanese name, whose digits may be wide ones; longer names are helper joints.</summary>
        private static string WideRole(string name)
        {
            string part = name.Normalize(NormalizationForm.FormKC).Trim().TrimEnd('0', '1', '2', '3', '4', '5', '6', '7', '8', '9');
            string side = part.Length == 0 ? null : Find(JointWords.WideSide, part.Substring(0, 1));
            if (side == null)
            {
                return Find(JointWords.WideCentral, part);
            }
            string found = Find(JointWords.WideSided, part.Substring(1));
            return found == null ? null : side + " " + found;
        }

        /// <summary>The number of the thumb where fingers are numbered: 0 in bipeds of 3ds Max, else 1.</summary>
        private static int FirstFinger(string[] names)
        {
            int[] numbers = names.Select(name => NumberedFinger.Match(name)).Where(found => found.Success)
                .Select(found => int.Parse(found.Groups[1].Value)).ToArray();
            return numbers.Length > 0 ? numbers.Min() : 1;
        }

        private static string Find(Dictionary<string, string> words, string word)
        {
            return words.TryGetValue(word, out string found) ? found : null;
        }

        private static bool IsAscii(string name)
        {
            return name.All(IsAscii);
        }

        private static bool IsAscii(char letter)
        {
            return letter < 128;
        }
    }
}
