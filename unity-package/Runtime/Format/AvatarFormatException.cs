using System;
using System.Globalization;

namespace Mua.Format
{
    /// <summary>A file that is not a sound `.muaavatar`; every reader reports the same code and field (schemas/README.md).</summary>
    public sealed class AvatarFormatException : Exception
    {
        /// <summary>What kind of fault it is: `truncated`, `offset`, `missing`, `shape` and so on.</summary>
        public string Code { get; }

        /// <summary>Path of the field, such as `geometry.details[0].mean`; empty for the file as a whole.</summary>
        public string Field { get; }

        internal AvatarFormatException(string code, string field, string sentence)
            : base(field.Length == 0 ? sentence : field + ": " + sentence)
        {
            Code = code;
            Field = field;
        }
    }

    /// <summary>Refuses a value outside its meaning: code `value`.</summary>
    internal static class Refusal
    {
        public static AvatarFormatException Of(string field, string sentence, params object[] values)
        {
            return new AvatarFormatException(
                "value", field, string.Format(CultureInfo.InvariantCulture, sentence, values));
        }
    }
}
