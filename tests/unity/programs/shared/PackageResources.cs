// The package's resources over stand-ins, which make shaders of files in place of Unity's importers.
using System.IO;
using System.Reflection;
using System.Text.RegularExpressions;
using StandIns;
using UnityEngine;

namespace Mua
{
    internal static class PackageResources
    {
        /// <summary>Puts them where AvatarResources.Load finds them. `folder`: of the kernels; a field is named as its file.</summary>
        public static AvatarResources Place(string folder)
        {
            AvatarResources resources = ScriptableObject.CreateInstance<AvatarResources>();
            foreach (FieldInfo field in typeof(AvatarResources).GetFields(BindingFlags.Instance | BindingFlags.NonPublic))
            {
                if (field.FieldType == typeof(Shader))
                {
                    string name = char.ToUpperInvariant(field.Name[0]) + field.Name.Substring(1);
                    field.SetValue(resources, Recorder.Drawing("Hidden/MUA/" + name));
                }
                else if (field.FieldType == typeof(ComputeShader))
                {
                    string stem = Regex.Replace(field.Name, "[A-Z]", found => "_" + found.Value.ToLowerInvariant());
                    field.SetValue(resources, Recorder.Compute(Path.Combine(folder, stem + ".compute")));
                }
            }
            Machine.Place("MuaAvatarResources", resources);
            return resources;
        }
    }
}
