namespace Mua.Format
{
    /// <summary>What stands in one slot of a table.</summary>
    internal enum Kind
    {
        Flag,
        U8,
        U16,
        U32,
        F32,
        F64,
        Enum,
        Text,
        Table,
    }

    /// <summary>One slot of a table.</summary>
    internal sealed class Field
    {
        public readonly string Name;
        public readonly Kind Kind;
        public readonly bool Vector;
        public readonly bool Required;
        public readonly int Align;

        /// <summary>Layout of the table or tables that the field points to.</summary>
        public readonly Layout Table;

        /// <summary>Names of an enum's values.</summary>
        public readonly string[] Names;

        public Field(
            string name, Kind kind, bool vector = false, bool required = false, int align = 0, Layout table = null,
            string[] names = null)
        {
            Name = name;
            Kind = kind;
            Vector = vector;
            Required = required;
            Align = align;
            Table = table;
            Names = names;
        }

        /// <summary>Whether the slot holds an offset instead of a value.</summary>
        public bool ByOffset => Vector || Kind == Kind.Text || Kind == Kind.Table;

        /// <summary>Bytes of one element; of an offset where it is no scalar.</summary>
        public int Width
        {
            get
            {
                switch (Kind)
                {
                    case Kind.Flag:
                    case Kind.U8:
                    case Kind.Enum:
                        return 1;
                    case Kind.U16:
                        return 2;
                    case Kind.F64:
                        return 8;
                    default:
                        return 4;
                }
            }
        }
    }

    /// <summary>The fields of one table in slot order; Layouts.cs holds those of the schema.</summary>
    internal sealed class Layout
    {
        public readonly Field[] Fields;

        public Layout(params Field[] fields)
        {
            Fields = fields;
        }

        public int Slot(string name)
        {
            int slot = 0;
            while (Fields[slot].Name != name)
            {
                slot++;
            }
            return slot;
        }
    }
}
