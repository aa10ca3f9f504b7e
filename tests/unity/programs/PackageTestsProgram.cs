// Runs the package's own editor tests, and what its editor does with golden files. Arguments: the package's folder or "-", the
// folder of the kernels, a recording to write or "-", the folder of its answers or "-", the story.
using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.Reflection;
using System.Threading;
using Mua;
using NUnit.Framework;
using StandIns;
using UnityEditor.Build;
using UnityEngine;
using UnityEngine.TestTools;

internal static class PackageTestsProgram
{
    private const BindingFlags Any = BindingFlags.Static | BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;
    private const int Patience = 3000; // frames

    public static int Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        PackageResources.Place(arguments[1]);
        Packages.Folder = arguments[0] == "-" ? null : arguments[0];
        Readbacks.Folder = arguments[3] == "-" ? null : arguments[3];
        if (arguments[2] != "-")
        {
            Recorder.Start(arguments[2]);
        }
        typeof(PackageTestsProgram).GetMethod(arguments[4], Any).Invoke(null, null);
        Say("alive", Recorder.AliveCount);
        if (arguments[2] != "-")
        {
            Recorder.Stop();
        }
        foreach (KeyValuePair<LogType, string> line in StandIns.Console.Lines)
        {
            Say(line.Key.ToString(), line.Value);
        }
        return 0;
    }

    private static void Menu()
    {
        Type.GetType("Mua.Editor.SelfTestCommand, Mua.Avatar.Editor", true).GetMethod("Execute", Any).Invoke(null, null);
        foreach (string shown in Dialogs.Shown)
        {
            Say("dialog", shown);
        }
    }

    private static void Builds()
    {
        Prepare("of another");
        UnityEditor.PlayerSettings.SetApplicationIdentifier(NamedBuildTarget.Android, "com.mua.player");
        Prepare("of the player");
    }

    private static void Prepare(string name)
    {
        Type type = Type.GetType("Mua.Editor.SelfTestData, Mua.Avatar.Editor", true);
        var processor = (BuildPlayerProcessor)Activator.CreateInstance(type, true);
        foreach (KeyValuePair<string, string> added in StandIns.Builds.Prepare(processor))
        {
            Say(name, added.Key + " " + added.Value);
        }
    }

    private static void EditMode()
    {
        Type type = Type.GetType("Mua.Tests.GoldenTests, Mua.Avatar.Editor.Tests", true);
        foreach (TestCaseData data in (IEnumerable<TestCaseData>)type.GetMethod("Cases", Any).Invoke(null, null))
        {
            Outcome(data.TestName, () => type.GetMethod("KernelMeetsGoldenCase").Invoke(Activator.CreateInstance(type), data.Arguments));
        }
        Outcome("GoldenFilesArePresent", () => type.GetMethod("GoldenFilesArePresent").Invoke(Activator.CreateInstance(type), null));
    }

    private static void EditModeWithoutCompute()
    {
        Machine.ComputeShaders(false);
        EditMode();
    }

    private static void PlayMode()
    {
        Type type = Type.GetType("Mua.Tests.AvatarTests, Mua.Avatar.Tests", true);
        foreach (MethodInfo test in type.GetMethods())
        {
            if (test.GetCustomAttribute<UnityTestAttribute>() != null)
            {
                Outcome(test.Name, () => Play(type, test));
            }
        }
    }

    private static void Play(Type type, MethodInfo test)
    {
        object fixture = Activator.CreateInstance(type);
        type.GetMethod("MakeScene").Invoke(fixture, null);
        try
        {
            Step((IEnumerator)test.Invoke(fixture, null));
        }
        finally
        {
            type.GetMethod("ClearScene").Invoke(fixture, null);
        }
    }

    private static void Step(IEnumerator steps)
    {
        for (int i = 0; i < Patience && steps.MoveNext(); i++)
        {
            if (steps.Current is IEnumerator inner)
            {
                Step(inner);
            }
            PlayerLoop.Frame(1f / 72);
            Thread.Sleep(1); // another thread reads
        }
    }

    private static void Outcome(string name, Action test)
    {
        string outcome = "passed";
        try
        {
            test();
        }
        catch (TargetInvocationException error)
        {
            outcome = error.InnerException.GetType().Name + " " + error.InnerException.Message;
        }
        catch (Exception error)
        {
            outcome = error.GetType().Name + " " + error.Message;
        }
        Say("test " + name, outcome);
    }

    private static void Say(string name, object value)
    {
        System.Console.WriteLine(name + "\t" + value);
    }
}
