// Prints what assemblies use of others, one a line: for tools/check_engine_api.py. Arguments: a folder with assemblies, then
// the names of those that use, then `--`, then the names of those that are used.
//
// Lines, parted by tabs: kind, type, name, static or instance, type of the value, parameters parted by `|`, `=` after
// those that a call may leave out. Kinds are type, constructor, method, get, set, field, add, remove; and, of all that is there,
// enum and const with their values.
// What a compiler puts in place by its value leaves no trace in an assembly.
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Runtime.CompilerServices;

internal static class UsedMembers
{
    private const int TypeReference = 0x01000000, MemberReference = 0x0A000000;
    private const BindingFlags Own = BindingFlags.DeclaredOnly | BindingFlags.Instance | BindingFlags.Static
        | BindingFlags.Public | BindingFlags.NonPublic;

    private static readonly Dictionary<string, string> Words = new Dictionary<string, string>
    {
        { "Void", "void" }, { "Boolean", "bool" }, { "Byte", "byte" }, { "SByte", "sbyte" }, { "Int16", "short" },
        { "UInt16", "ushort" }, { "Int32", "int" }, { "UInt32", "uint" }, { "Int64", "long" }, { "UInt64", "ulong" },
        { "Single", "float" }, { "Double", "double" }, { "Char", "char" }, { "String", "string" }, { "Object", "object" },
    };

    private static readonly SortedSet<string> Lines = new SortedSet<string>(StringComparer.Ordinal);
    private static HashSet<string> used;

    public static int Main(string[] arguments)
    {
        int middle = Array.IndexOf(arguments, "--");
        string folder = arguments[0];
        used = new HashSet<string>(arguments.Skip(middle + 1));
        AppDomain.CurrentDomain.AssemblyResolve += (sender, asked) =>
            Assembly.LoadFrom(Path.Combine(folder, new AssemblyName(asked.Name).Name + ".dll"));
        foreach (string name in arguments.Skip(1).Take(middle - 1))
        {
            List(Assembly.LoadFrom(Path.Combine(folder, name + ".dll")));
        }
        foreach (string name in used)
        {
            Assembly.LoadFrom(Path.Combine(folder, name + ".dll")).GetTypes().ToList().ForEach(Values);
        }
        Console.Write(string.Join("\n", Lines));
        return 0;
    }

    private static void List(Assembly assembly)
    {
        foreach (Type type in Each(TypeReference, assembly.ManifestModule.ResolveType))
        {
            Say(type, "type", type, "", "", "", "");
        }
        foreach (MemberInfo member in Each(MemberReference, assembly.ManifestModule.ResolveMember))
        {
            Member(member);
        }
        foreach (Type type in assembly.GetTypes())
        {
            Overrides(type);
            Attributes(type.CustomAttributes.Concat(type.GetMembers(Own).SelectMany(member => member.CustomAttributes)));
        }
        Attributes(assembly.CustomAttributes);
    }

    private static IEnumerable<T> Each<T>(int table, Func<int, T> resolve)
    {
        for (int row = 1; ; row++)
        {
            T found;
            try
            {
                found = resolve(table | row);
            }
            catch (ArgumentException)
            {
                yield break; // after the last
            }
            yield return found;
        }
    }

    private static void Member(MemberInfo member)
    {
        var method = member as MethodInfo;
        var field = member as FieldInfo;
        var constructor = member as ConstructorInfo;
        Type type = member.DeclaringType;
        if (type == null || !IsUsed(type))
        {
            return;
        }
        type = type.IsGenericType ? type.GetGenericTypeDefinition() : type;
        member = type.GetMembers(Own).First(each => each.MetadataToken == member.MetadataToken); // with its own T
        method = member as MethodInfo;
        field = member as FieldInfo;
        constructor = member as ConstructorInfo;
        if (constructor != null)
        {
            Say(type, "constructor", type, "", "", "", Parameters(constructor));
        }
        else if (field != null)
        {
            Say(type, "field", type, field.Name, Static(field.IsStatic), Name(field.FieldType), "");
        }
        else if (method != null)
        {
            Method(type, method);
        }
    }

    private static void Method(Type type, MethodInfo method)
    {
        string name = method.Name;
        int underscore = name.IndexOf('_');
        string kind = method.IsSpecialName ? name.Substring(0, underscore) : "method";
        string value = kind == "set" || kind == "add" || kind == "remove"
            ? Name(method.GetParameters().Last().ParameterType) : Name(method.ReturnType);
        string parameters = Parameters(method);
        if (kind == "set")
        {
            parameters = string.Join("|", parameters.Split('|').Reverse().Skip(1).Reverse());
        }
        else if (kind == "add" || kind == "remove")
        {
            parameters = "";
        }
        Say(type, kind == "op" ? "method" : kind, type, kind == "method" || kind == "op" ? name : name.Substring(underscore + 1),
            Static(method.IsStatic), value, parameters);
    }

    private static void Overrides(Type type)
    {
        foreach (MethodInfo method in type.GetMethods(Own).Where(each => each.IsVirtual))
        {
            MethodInfo first = method.GetBaseDefinition();
            if (first.DeclaringType != type && IsUsed(first.DeclaringType))
            {
                Member(first);
            }
        }
        foreach (Type contract in type.GetInterfaces().Where(IsUsed))
        {
            foreach (MethodInfo method in contract.GetMethods())
            {
                Member(method);
            }
        }
    }

    private static void Attributes(IEnumerable<CustomAttributeData> attributes)
    {
        foreach (CustomAttributeNamedArgument named in attributes.SelectMany(each => each.NamedArguments))
        {
            Type type = named.MemberInfo.DeclaringType;
            if (IsUsed(type))
            {
                Say(type, named.IsField ? "field" : "set", type, named.MemberName, "instance",
                    Name(named.TypedValue.ArgumentType), "");
            }
        }
    }

    /// <summary>Enum members and constants, whether anybody uses them or not.</summary>
    private static void Values(Type type)
    {
        foreach (FieldInfo field in type.GetFields(Own).Where(each => each.IsLiteral))
        {
            Say(type, type.IsEnum ? "enum" : "const", type, field.Name, "static", Name(field.FieldType),
                Convert.ToString(field.GetRawConstantValue(), System.Globalization.CultureInfo.InvariantCulture));
        }
    }

    private static bool IsUsed(Type type)
    {
        return type != null && used.Contains(type.Assembly.GetName().Name) && type.Namespace != "StandIns";
    }

    private static void Say(Type declaring, string kind, Type type, string name, string isStatic, string value, string more)
    {
        if (IsUsed(declaring))
        {
            Lines.Add(string.Join("\t", kind, Full(type), name, isStatic, value, more));
        }
    }

    private static string Static(bool isStatic)
    {
        return isStatic ? "static" : "instance";
    }

    private static string Parameters(MethodBase method)
    {
        return string.Join("|", method.GetParameters().Select(each =>
        {
            string by = !each.ParameterType.IsByRef ? "" : each.IsOut ? "out " : each.IsIn ? "in " : "ref ";
            return by + Name(each.ParameterType) + (each.IsOptional ? " =" : "");
        }));
    }

    /// <summary>As it is written where its namespace is open and its type too.</summary>
    private static string Name(Type type)
    {
        if (type.IsByRef)
        {
            return Name(type.GetElementType());
        }
        if (type.IsArray)
        {
            return Name(type.GetElementType()) + "[" + new string(',', type.GetArrayRank() - 1) + "]";
        }
        if (type.IsGenericParameter)
        {
            return (type.DeclaringMethod == null ? "!" : "!!") + type.GenericParameterPosition;
        }
        string name = type.Name.Split('`')[0];
        string word;
        if (type.Namespace == "System" && Words.TryGetValue(name, out word))
        {
            return word;
        }
        Type[] given = type.GetGenericArguments().Skip(type.IsNested ? type.DeclaringType.GetGenericArguments().Length : 0).ToArray();
        return given.Length == 0 ? name : name + "<" + string.Join(",", given.Select(Name)) + ">";
    }

    private static string Full(Type type)
    {
        type = type.IsGenericType ? type.GetGenericTypeDefinition() : type;
        return type.FullName.Replace('+', '.');
    }
}
