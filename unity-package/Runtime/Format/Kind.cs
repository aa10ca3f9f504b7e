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
}
