namespace Mua.Format
{
    /// <summary>How a tensor's elements are stored; the values are those of the file.</summary>
    public enum ElementType : byte
    {
        F32,
        F16,
        I8,
        I32,
    }
}
