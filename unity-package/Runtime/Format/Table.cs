namespace Mua.Format
{
    /// <summary>A vector of scalars: its first byte and its number of elements.</summary>
    internal sealed class Block
    {
        /// <summary>What holds it; null: the file.</summary>
        public byte[] Content;

        public int Offset;
        public int Count;
    }

    /// <summary>A parsed table: one value for each field of its layout, null where an optional one is absent.</summary>
    internal sealed class Table
    {
        private readonly Layout layout;
        private readonly object[] values;
        private readonly int[] positions;

        public Table(Layout layout, object[] values, int[] positions)
        {
            this.layout = layout;
            this.values = values;
            this.positions = positions;
        }

        public Field[] Fields => layout.Fields;

        public bool Is(Layout other)
        {
            return layout == other;
        }

        public Table Child(string field)
        {
            return (Table)values[layout.Slot(field)];
        }

        public Table[] Children(string field)
        {
            return (Table[])values[layout.Slot(field)];
        }

        public string Text(string field)
        {
            return (string)values[layout.Slot(field)];
        }

        public string[] Texts(string field)
        {
            return (string[])values[layout.Slot(field)];
        }

        /// <summary>Integers, enums and flags; 0 where absent.</summary>
        public long Number(string field)
        {
            return (long)values[layout.Slot(field)];
        }

        public float Real(string field)
        {
            return (float)values[layout.Slot(field)];
        }

        /// <summary>A vector of scalars; null where absent.</summary>
        public Block Block(string field)
        {
            return (Block)values[layout.Slot(field)];
        }

        /// <summary>Puts another vector in the place of one.</summary>
        public void Replace(string field, Block block)
        {
            values[layout.Slot(field)] = block;
        }

        /// <summary>The byte at which a field's scalar or offset stands, 0 where the file leaves it out.</summary>
        public int Position(string field)
        {
            return positions[layout.Slot(field)];
        }

        /// <summary>Bytes of all vectors of scalars in a field and below it.</summary>
        public long Held(string field)
        {
            return Held(layout.Slot(field));
        }

        private long Held()
        {
            long held = 0;
            for (int slot = 0; slot < values.Length; slot++)
            {
                held += Held(slot);
            }
            return held;
        }

        private long Held(int slot)
        {
            if (values[slot] is Block block)
            {
                return (long)block.Count * layout.Fields[slot].Width;
            }
            if (values[slot] is Table child)
            {
                return child.Held();
            }
            long held = 0;
            if (values[slot] is Table[] children)
            {
                foreach (Table table in children)
                {
                    held += table.Held();
                }
            }
            return held;
        }
    }
}
