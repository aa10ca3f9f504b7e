using System;
using System.Globalization;

namespace Mua.Samples.VrPlayer
{
    /// <summary>Text that is built again and again in one buffer; what does not fit is left out.</summary>
    internal sealed class PanelText
    {
        private static readonly string[] Formats = { "F0", "F1", "F2" }; // by digits

        private readonly char[] characters = new char[2048];
        private int length;

        public PanelText Clear()
        {
            length = 0;
            return this;
        }

        public PanelText Add(string text)
        {
            return Add(text, 0, text.Length);
        }

        /// <summary>Text in lines of at most so many characters, parted at spaces where there are any.</summary>
        public PanelText Wrap(string text, int columns)
        {
            int start = 0;
            while (text.Length - start > columns)
            {
                int space = text.LastIndexOf(' ', start + columns, columns);
                int end = space > start ? space : start + columns;
                Add(text, start, end).Line();
                start = space > start ? space + 1 : end;
            }
            return Add(text, start, text.Length);
        }

        public PanelText Line()
        {
            Add('\n');
            return this;
        }

        public PanelText Add(int value)
        {
            value.TryFormat(new Span<char>(characters, length, characters.Length - length), out int written);
            length += written;
            return this;
        }

        /// <summary>A number that is not negative, with so many digits behind the point; a dash where it is NaN.</summary>
        public PanelText Add(double value, int digits)
        {
            if (!(value >= 0 && value < int.MaxValue))
            {
                return Add("-");
            }
            Span<char> rest = new Span<char>(characters, length, characters.Length - length);
            value.TryFormat(rest, out int written, Formats[digits], CultureInfo.InvariantCulture);
            length += written;
            return this;
        }

        public bool Same(string text)
        {
            return text != null && text.Length == length
                && text.AsSpan().SequenceEqual(new ReadOnlySpan<char>(characters, 0, length));
        }

        public override string ToString()
        {
            return new string(characters, 0, length);
        }

        private PanelText Add(string text, int start, int end)
        {
            for (int i = start; i < end; i++)
            {
                Add(text[i]);
            }
            return this;
        }

        private void Add(char character)
        {
            if (length < characters.Length)
            {
                characters[length++] = character;
            }
        }
    }
}
