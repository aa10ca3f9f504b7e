// Stand-in. Source: manual of com.unity.test-framework 1.4.
using System;

namespace UnityEngine.TestTools
{
    [AttributeUsage(AttributeTargets.Method)] public class UnityTestAttribute : NUnit.Framework.TestAttribute { }

    public static class LogAssert
    {
        public static void Expect(LogType type, System.Text.RegularExpressions.Regex message) { }
        public static void NoUnexpectedReceived() { }
    }
}
