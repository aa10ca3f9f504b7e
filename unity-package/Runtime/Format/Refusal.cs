using System.Globalization;

namespace Mua.Format
{
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
