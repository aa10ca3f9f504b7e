// Prints what compiled assemblies declare to Unity and to scripts, one word of kind before each. Arguments: the assemblies.
using System;
using System.Linq;
using System.Reflection;
using UnityEditor;
using UnityEngine;

internal static class PackageProgram
{
    private const BindingFlags Own = BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly;

    private static int Main(string[] paths)
    {
        foreach (Type type in paths.SelectMany(path => Assembly.LoadFrom(path).GetTypes()))
        {
            foreach (FieldInfo field in type.GetFields(Own | BindingFlags.Instance))
            {
                Print(type, field);
            }
            foreach (MethodInfo method in type.GetMethods(Own | BindingFlags.Static))
            {
                Print(type, method);
            }
            if (type.IsPublic)
            {
                foreach (MemberInfo member in type.GetMembers(Own ^ BindingFlags.NonPublic | BindingFlags.Instance | BindingFlags.Static))
                {
                    Print("member", type, member);
                }
            }
        }
        return 0;
    }

    /// <summary>Tooltip, Range and the like are PropertyAttributes: they do nothing to a field that is not serialized.</summary>
    private static void Print(Type type, FieldInfo field)
    {
        bool isSerialized = field.IsPublic || Attribute.IsDefined(field, typeof(SerializeField));
        if (isSerialized)
        {
            Print("serialized", type, field);
        }
        else if (Attribute.IsDefined(field, typeof(PropertyAttribute)))
        {
            Print("lost", type, field);
        }
    }

    private static void Print(Type type, MethodInfo method)
    {
        foreach (MenuItem item in method.GetCustomAttributes(typeof(MenuItem), false))
        {
            Console.WriteLine("menu\t" + item.menuItem);
        }
        if (method.IsPublic && type.IsPublic && method.ReturnType == typeof(void) && method.GetParameters().Length == 0)
        {
            Print("command", type, method);
        }
    }

    private static void Print(string kind, Type type, MemberInfo member)
    {
        Console.WriteLine(kind + "\t" + type.FullName + "." + member.Name);
    }
}
