// Stand-in. Source: NUnit 3 reference: what the package's tests use.
using System;
using System.Collections;

namespace NUnit.Framework
{
    [AttributeUsage(AttributeTargets.Method)] public class TestAttribute : Attribute { }
    [AttributeUsage(AttributeTargets.Method)] public class SetUpAttribute : Attribute { }
    [AttributeUsage(AttributeTargets.Method)] public class TearDownAttribute : Attribute { }
    [AttributeUsage(AttributeTargets.Method)]
    public class TestCaseSourceAttribute : Attribute { public TestCaseSourceAttribute(string sourceName) { } }

    public class TestCaseData
    {
        public TestCaseData(params object[] args) { Arguments = args; }

        public object[] Arguments { get; private set; }
        public string TestName { get; private set; }
        public TestCaseData SetName(string name)
        {
            TestName = name;
            return this;
        }
    }

    public class AssertionException : Exception { public AssertionException(string message) : base(message) { } }
    public class IgnoreException : Exception { public IgnoreException(string message) : base(message) { } }

    public static class Assert
    {
        public static void AreEqual(object expected, object actual) { AreEqual(expected, actual, ""); }
        public static void AreEqual(object expected, object actual, string message) { Require(Equals(expected, actual), message + " " + expected + " " + actual); }
        public static void AreNotEqual(object expected, object actual) { Require(!Equals(expected, actual), "" + actual); }
        public static void IsTrue(bool condition, string message) { Require(condition, message); }
        public static void IsEmpty(string aString) { Require(aString.Length == 0, aString); }
        public static void Ignore(string message) { throw new IgnoreException(message); }

        private static void Require(bool isRight, string message)
        {
            if (!isRight)
                throw new AssertionException(message);
        }
    }
}
