// Words of a scenario: the numbers, Unity's matrices row by row, and places (position x, y, z, then rotation x, y, z, w, then size).
using System.Globalization;
using Mua.Format;
using UnityEngine;

namespace Mua
{
    internal static class Scenario
    {
        public static float Number(string[] words, int index)
        {
            return float.Parse(words[index], CultureInfo.InvariantCulture);
        }

        public static Matrix4x4 Matrix(string[] words, int first)
        {
            var matrix = new Matrix4x4();
            for (int i = 0; i < 16; i++)
            {
                matrix[i / 4, i % 4] = Number(words, first + i);
            }
            return matrix;
        }

        public static AvatarPlace Place(string[] words, int first)
        {
            var position = new Vector3(Number(words, first), Number(words, first + 1), Number(words, first + 2));
            var rotation = new Quaternion(
                Number(words, first + 3), Number(words, first + 4), Number(words, first + 5), Number(words, first + 6));
            return new AvatarPlace(position, rotation, Number(words, first + 7));
        }
    }
}
