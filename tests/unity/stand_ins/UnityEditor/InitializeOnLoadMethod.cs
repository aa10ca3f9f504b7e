// Stand-in. Source: Unity 6000.0 scripting reference, InitializeOnLoadMethodAttribute.
using System;

namespace UnityEditor
{
    [AttributeUsage(AttributeTargets.Method)]
    public sealed class InitializeOnLoadMethodAttribute : Attribute { }
}
