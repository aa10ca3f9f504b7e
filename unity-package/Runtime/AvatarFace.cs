using System.Collections.Generic;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// A mesh whose blend shapes set the weights of an avatar's expressions of equal names, whoever moves them: a face tracker,
    /// an Animator, a script.
    /// </summary>
    internal sealed class AvatarFace
    {
        private const float Whole = 100; // weight of a blend shape

        private readonly AvatarExpressions expressions;
        private readonly SkinnedMeshRenderer mesh;
        private readonly List<int> shapes = new List<int>(), followers = new List<int>(); // expressions that follow them

        public AvatarFace(AvatarExpressions expressions, SkinnedMeshRenderer mesh)
        {
            this.expressions = expressions;
            this.mesh = mesh;
            Mesh shared = mesh.sharedMesh;
            var byName = new Dictionary<string, int>();
            for (int shape = shared == null ? -1 : shared.blendShapeCount - 1; shape >= 0; shape--) // the first of a name stays
            {
                byName[Plain(shared.GetBlendShapeName(shape))] = shape;
            }
            for (int i = 0; i < expressions.Names.Count; i++)
            {
                if (byName.TryGetValue(Plain(expressions.Names[i]), out int shape))
                {
                    shapes.Add(shape);
                    followers.Add(i);
                }
            }
        }

        /// <summary>A sentence where it moves nothing, or nothing.</summary>
        public string Missing => followers.Count > 0
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
            for (int i = 0; i < shapes.Count; i++)
            {
                float weight = mesh.GetBlendShapeWeight(shapes[i]);
                expressions.Set(followers[i], float.IsNaN(weight) ? 0 : weight / Whole);
            }
        }

        /// <summary>Gives its expressions back to the clip.</summary>
        public void Release()
        {
            foreach (int expression in followers)
            {
                expressions.Set(expression, float.NaN);
            }
        }

        /// <summary>A name without case, underscores, and what exporters put before a point: blendShape1.mouthSmile_L.</summary>
        private static string Plain(string name)
        {
            return name.Substring(name.LastIndexOf('.') + 1).Replace("_", "").ToLowerInvariant();
        }
    }
}
