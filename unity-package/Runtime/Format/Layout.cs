namespace Mua.Format
{
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
