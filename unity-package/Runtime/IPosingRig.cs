namespace Mua
{
    /// <summary>Transforms that pose an avatar.</summary>
    internal interface IPosingRig : IPoseSource
    {
        /// <summary>A sentence about joints that keep their bind pose, or nothing.</summary>
        string Missing { get; }

        /// <summary>Whether the transforms are still there.</summary>
        bool Alive { get; }
    }
}
