using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Mua.Format
{
    /// <summary>
    /// Walks a FlatBuffer by the generated layout and checks every position before it is used; mirrors
    /// python/mua/asset/flatbuffer.py check for check. https://flatbuffers.dev/internals/ describes the bytes.
    /// </summary>
    internal sealed class Parser
    {
        /// <summary>What to do with a file that is not what was written.</summary>
        public const string Again = "download or copy it again";

        private const int OffsetWidth = 4;
        private static readonly UTF8Encoding Utf8 = new UTF8Encoding(false, true);

        private readonly byte[] content;
        private long left; // bytes that no table or vector has claimed yet
        private long stated; // bytes that the file says it has; 0 where it does not

        private Parser(byte[] content)
        {
            this.content = content;
            left = content.Length;
        }

        /// <summary>The root table, every offset, length, alignment and text checked.</summary>
        public static Table Parse(byte[] content)
        {
            if (content.Length < 8)
            {
                throw Cut(content.Length, 8);
            }
            string identifier = Layouts.Identifier;
            for (int i = 0; i < identifier.Length; i++)
            {
                if (content[4 + i] != identifier[i])
                {
                    throw Fault("identifier", "", "the file is no .muaavatar: bytes 4 to 7 are not " + identifier);
                }
            }
            new Parser(content).RequireVersion();
            return new Parser(content).ReadTable(Layouts.Root, 0, "");
        }

        /// <summary>Looks at the version before anything else is trusted.</summary>
        private void RequireVersion()
        {
            Layout root = Layouts.Root;
            int slot = root.Slot("version_major");
            int at = FindFields(root, Follow(0, ""), "")[slot];
            long version = at == 0 ? 0 : (long)ReadScalar(root.Fields[slot], at, "version_major");
            if (version != Limits.Major)
            {
                throw Fault(
                    "version", "version_major",
                    "format version " + version + ", expected " + Limits.Major + ": update mua where the file is newer");
            }
        }

        /// <summary>The table that the offset at byte `at` points to.</summary>
        private Table ReadTable(Layout layout, int at, string path)
        {
            int[] positions = FindFields(layout, Follow(at, path), path);
            if (layout == Layouts.Root && positions[layout.Slot("stages")] != 0)
            {
                stated = LastWord(positions[layout.Slot("stages")]);
            }
            var values = new object[layout.Fields.Length];
            for (int slot = 0; slot < values.Length; slot++)
            {
                Field field = layout.Fields[slot];
                if (positions[slot] != 0)
                {
                    values[slot] = ReadValue(field, positions[slot], Join(path, field.Name));
                }
                else if (field.Required)
                {
                    throw Fault("missing", Join(path, field.Name), "the field is required and absent");
                }
                else if (!field.ByOffset)
                {
                    values[slot] = field.Kind == Kind.F32 ? (object)0f : 0L;
                }
            }
            return new Table(layout, values, positions);
        }

        /// <summary>Byte positions of the fields that the table at `start` holds, 0 for absent ones.</summary>
        private int[] FindFields(Layout layout, int start, string path)
        {
            long vtable = start - (long)(int)ReadWord(start, path);
            int size = ReadShort(vtable, path), inline = ReadShort(vtable + 2, path);
            if (size < 4 || size % 2 != 0 || vtable % 2 != 0 || inline < 4)
            {
                throw Fault("offset", path, "the table's description at byte " + vtable + " is malformed");
            }
            RequireWithin(vtable, size, path);
            RequireWithin(start, inline, path);
            Claim(inline, path);
            var positions = new int[layout.Fields.Length];
            for (int slot = 0; slot < positions.Length && 4 + 2 * slot < size; slot++)
            {
                Field field = layout.Fields[slot];
                int offset = ReadShort(vtable + 4 + 2 * slot, path), width = field.ByOffset ? OffsetWidth : field.Width;
                if (offset == 0)
                {
                    continue;
                }
                if (offset < 4 || offset + width > inline || (start + (long)offset) % width != 0)
                {
                    throw Fault(
                        "offset", Join(path, field.Name),
                        "offset " + offset + " lies outside its table of " + inline + " bytes");
                }
                positions[slot] = start + offset;
            }
            return positions;
        }

        private object ReadValue(Field field, int at, string path)
        {
            if (!field.ByOffset)
            {
                return ReadScalar(field, at, path);
            }
            if (!field.Vector)
            {
                return field.Kind == Kind.Text ? (object)ReadText(at, path) : ReadTable(field.Table, at, path);
            }
            Block vector = ReadVector(at, path, field.Width);
            if (field.Kind == Kind.Text)
            {
                var texts = new List<string>();
                for (int i = 0; i < vector.Count; i++)
                {
                    texts.Add(ReadText(vector.Offset + OffsetWidth * i, path + "[" + i + "]"));
                }
                return texts.ToArray();
            }
            if (field.Kind == Kind.Table)
            {
                var tables = new List<Table>();
                for (int i = 0; i < vector.Count; i++)
                {
                    tables.Add(ReadTable(field.Table, vector.Offset + OffsetWidth * i, path + "[" + i + "]"));
                }
                return tables.ToArray();
            }
            if (vector.Offset % Math.Max(field.Align, field.Width) != 0)
            {
                throw Fault("offset", path, "the data at byte " + vector.Offset + " is not aligned");
            }
            return vector;
        }

        private object ReadScalar(Field field, int at, string path)
        {
            switch (field.Kind)
            {
                case Kind.F32:
                    return MemoryMarshal.Read<float>(new ReadOnlySpan<byte>(content, at, 4));
                case Kind.U32:
                    return (long)ReadWord(at, path);
                case Kind.U16:
                    return (long)ReadShort(at, path);
                case Kind.Enum:
                    if (content[at] >= field.Names.Length)
                    {
                        throw Fault(
                            "enum", path,
                            "value " + content[at] + " is unknown, expected one of " + string.Join(", ", field.Names));
                    }
                    return (long)content[at];
                default:
                    return (long)content[at];
            }
        }

        private string ReadText(int at, string path)
        {
            Block text = ReadVector(at, path, 1);
            string found;
            try
            {
                found = Utf8.GetString(content, text.Offset, text.Count);
            }
            catch (DecoderFallbackException)
            {
                throw Fault("text", path, "the text is not UTF-8");
            }
            foreach (char letter in found)
            {
                if (char.IsControl(letter) && !(path == "notes" && (letter == '\n' || letter == '\t')))
                {
                    throw Fault("text", path, "the text holds the control character U+" + ((int)letter).ToString("X4"));
                }
            }
            return found;
        }

        private Block ReadVector(int at, string path, int width)
        {
            int start = Follow(at, path);
            long count = ReadWord(start, path);
            RequireWithin(start + 4L, count * width, path);
            Claim(4 + count * width, path);
            return new Block { Offset = start + 4, Count = (int)count };
        }

        /// <summary>Refuses parts that overlap: else a small file could name one part a million times.</summary>
        private void Claim(long size, string path)
        {
            left -= size;
            if (left < 0)
            {
                throw Fault("offset", path, "parts of the file overlap");
            }
        }

        private int Follow(int at, string path)
        {
            long start = at + (long)ReadWord(at, path);
            if (start % 4 != 0)
            {
                throw Fault("offset", path, "the offset at byte " + at + " points to unaligned byte " + start);
            }
            RequireWithin(start, 4, path);
            return (int)start;
        }

        private uint ReadWord(long at, string path)
        {
            RequireWithin(at, 4, path);
            return MemoryMarshal.Read<uint>(new ReadOnlySpan<byte>(content, (int)at, 4));
        }

        private ushort ReadShort(long at, string path)
        {
            RequireWithin(at, 2, path);
            return MemoryMarshal.Read<ushort>(new ReadOnlySpan<byte>(content, (int)at, 2));
        }

        private void RequireWithin(long at, long size, string path)
        {
            if (at < 0)
            {
                throw Fault("truncated", path, "an offset leads before the first byte of the file");
            }
            if (at + size > content.Length)
            {
                throw Cut(content.Length, Math.Max(at + size, stated));
            }
        }

        /// <summary>The last number of the vector that the offset at byte `at` points to; 0 where the file does not hold it.</summary>
        private uint LastWord(long at)
        {
            long start = at + Peek(at);
            return Peek(start + 4L * Peek(start));
        }

        private uint Peek(long at)
        {
            return at + 4 <= content.Length ? MemoryMarshal.Read<uint>(new ReadOnlySpan<byte>(content, (int)at, 4)) : 0;
        }

        private static AvatarFormatException Cut(int size, long needed)
        {
            return Fault(
                "truncated", "",
                "the file has " + size + " bytes and needs at least " + needed + ": it is cut short or damaged; " + Again);
        }

        private static string Join(string path, string name)
        {
            return path.Length == 0 ? name : path + "." + name;
        }

        private static AvatarFormatException Fault(string code, string field, string sentence)
        {
            return new AvatarFormatException(code, field, sentence);
        }
    }
}
