namespace Mua.Format
{
    /// <summary>A vector of scalars in the file: its first byte and its number of elements.</summary>
    internal sealed class Block
    {
        public readonly int Offset;
        public readonly int Count;

        public Block(int offset, int count)
        {
            Offset = offset;
            Count = count;
        }
    }
}
