using System;

namespace Mua
{
    /// <summary>Poses of this moment, whatever makes them.</summary>
    internal interface IPoseSource
    {
        /// <summary>Writes local rotations [J, 4] and translations [J, 3], metres.</summary>
        void Read(Span<double> rotations, Span<double> translations);

        /// <summary>
        /// Overwrites a window of local rotations [k, J, 4] and translations [k, J, 3], newest first, with the poses up to this
        /// moment, where the source knows what was before.
        /// </summary>
        void ReadWindow(Span<double> rotations, Span<double> translations);

        /// <summary>The weight of one of the avatar's expressions.</summary>
        float Weight(int expression);
    }
}
