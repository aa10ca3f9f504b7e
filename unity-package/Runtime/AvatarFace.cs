using System.Collections.Generic;
using Mua.Motion;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// A mesh whose blend shapes set the weights of an avatar's expressions, of equal names or the nearest, whoever moves them:
    /// a face tracker, an Animator, a script.
    /// </summary>
    internal sealed class AvatarFace
    {
        private const float Whole = 100; // weight of a blend shape

        private readonly AvatarExpressions expressions;
        private readonly SkinnedMeshRenderer mesh;
        private readonly List<int> shapes = new List<int>(); // [S] that may move expressions
        private readonly List<float> wholes = new List<float>(); // [S] weights of those at which an expression is whole
        private readonly float[] weights; // [S] of expressions
        private readonly ExpressionMapping mapping;
        private readonly bool moves;

        public AvatarFace(AvatarExpressions expressions, SkinnedMeshRenderer mesh)
        {
            this.expressions = expressions;
            this.mesh = mesh;
            Mesh shared = mesh.sharedMesh;
            var names = new List<string>();
            for (int shape = 0; shape < (shared == null ? 0 : shared.blendShapeCount); shape++)
            {
                foreach (KeyValuePair<string, float> way in ExpressionNames.OfShape(shared.GetBlendShapeName(shape)))
                {
                    string name = OwnName(way.Key);
                    if (!names.Contains(name)) // the first of a name stays
                    {
                        names.Add(name);
                        shapes.Add(shape);
                        wholes.Add(Whole * way.Value);
                    }
                }
            }
            weights = new float[names.Count];
            mapping = new ExpressionMapping(expressions, names);
            for (int i = 0; i < names.Count; i++)
            {
                moves |= mapping.Moves(i);
            }
        }

        /// <summary>A sentence where it moves nothing, or nothing.</summary>
        public string Missing => moves
            ? ""
            : expressions.Names.Count == 0
                ? "the avatar has no expressions, so that the blend shapes of " + mesh.name + " move nothing."
                : "no blend shape of " + mesh.name + " has the name of one of the avatar's expressions, such as "
                    + expressions.Names[0] + ".";

        /// <summary>Whether the mesh is still there.</summary>
        public bool Alive => mesh != null;

        /// <summary>Sets the weights of this moment.</summary>
        public void Read()
        {
            for (int i = 0; i < weights.Length; i++)
            {
                float weight = mesh.GetBlendShapeWeight(shapes[i]);
                weights[i] = float.IsNaN(weight) ? 0 : weight / wholes[i];
            }
            mapping.Apply(weights);
        }

        /// <summary>Gives its expressions back to the clip.</summary>
        public void Release()
        {
            mapping.Release();
        }

        /// <summary>The avatar's name for an expression that a blend shape's is like, else the blend shape's.</summary>
        private string OwnName(string shape)
        {
            if (expressions.Find(shape) < 0)
            {
                foreach (string name in expressions.Names)
                {
                    if (Plain(name) == Plain(shape))
                    {
                        return name;
                    }
                }
            }
            return shape;
        }

        /// <summary>A name without case, underscores, and what exporters put before a point: blendShape1.mouthSmile_L.</summary>
        private static string Plain(string name)
        {
            return name.Substring(name.LastIndexOf('.') + 1).Replace("_", "").ToLowerInvariant();
        }
    }
}
