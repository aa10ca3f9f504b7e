// Prints which fields of compiled assemblies the inspector describes, and whether Unity keeps them. Arguments: the assemblies.
using System;
using System.Reflection;
using UnityEngine;

internal static class InspectorProgram
{
    private const BindingFlags All = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly;

    private static int Main(string[] arguments)
    {
        foreach (string path in arguments)
        {
            foreach (Type type in Assembly.LoadFrom(path).GetTypes())
            {
                foreach (FieldInfo field in type.GetFields(All))
                {
                    Tell(type, field);
                }
            }
        }
        return 0;
    }

    /// <summary>Tooltip, Range and the like are PropertyAttributes: they do nothing to a field that is not serialized.</summary>
    private static void Tell(Type type, FieldInfo field)
    {
        if (Attribute.IsDefined(field, typeof(PropertyAttribute)))
        {
            bool isKept = field.IsPublic || Attribute.IsDefined(field, typeof(SerializeField));
            Console.WriteLine((isKept ? "kept" : "lost") + "\t" + type.Name + "." + field.Name);
        }
    }
}
