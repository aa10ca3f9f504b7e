// Stand-in. Source: Unity 6000.0 scripting reference, Debug, Application, Time, Screen, SystemInfo, QualitySettings.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public enum LogType { Error, Assert, Warning, Log, Exception }
    public enum LogOption { None, NoStacktrace }

    public static class Debug
    {
        public static void Log(object message) { StandIns.Console.Write(LogType.Log, message, null); }
        public static void Log(object message, Object context) { StandIns.Console.Write(LogType.Log, message, context); }
        public static void LogWarning(object message) { StandIns.Console.Write(LogType.Warning, message, null); }
        public static void LogWarning(object message, Object context) { StandIns.Console.Write(LogType.Warning, message, context); }
        public static void LogError(object message) { StandIns.Console.Write(LogType.Error, message, null); }
        public static void LogError(object message, Object context) { StandIns.Console.Write(LogType.Error, message, context); }
        public static void LogException(Exception exception) { StandIns.Console.Write(LogType.Exception, exception, null); }
        public static void LogException(Exception exception, Object context) { StandIns.Console.Write(LogType.Exception, exception, context); }
        public static void LogFormat(string format, params object[] args) { Log(string.Format(format, args)); }
        public static void LogFormat(LogType logType, LogOption logOptions, Object context, string format, params object[] args)
        {
            StandIns.Console.Write(logType, string.Format(format, args), context);
        }
        public static void Assert(bool condition, string message) { if (!condition) StandIns.Console.Write(LogType.Assert, message, null); }
    }

    public enum RuntimePlatform { OSXEditor = 0, WindowsPlayer = 2, WindowsEditor = 7, Android = 11, LinuxPlayer = 13, LinuxEditor = 16, WebGLPlayer = 17 }

    public static class Application
    {
        public delegate void LogCallback(string condition, string stackTrace, LogType type);

        public static event LogCallback logMessageReceived;
        public static event Events.UnityAction onBeforeRender;

        static Application()
        {
            isPlaying = true;
            platform = RuntimePlatform.LinuxPlayer;
            streamingAssetsPath = persistentDataPath = dataPath = System.IO.Path.GetTempPath();
        }

        public static bool isPlaying { get; internal set; }
        public static bool isEditor { get { return false; } }
        public static bool isMobilePlatform { get { return platform == RuntimePlatform.Android; } }
        public static bool isBatchMode { get { return StandIns.Process.IsBatchMode; } }
        public static RuntimePlatform platform { get; internal set; }
        public static string streamingAssetsPath { get; internal set; }
        public static string persistentDataPath { get; internal set; }
        public static string dataPath { get; internal set; }
        public static string unityVersion { get { return "6000.0.0f1"; } }
        public static string version { get { return "0"; } }
        public static string identifier { get { return "org.mua.player"; } }
        public static void Quit() { Quit(0); }
        public static void Quit(int exitCode) { StandIns.Machine.ExitCode = exitCode; }

        internal static void BeforeRender()
        {
            if (onBeforeRender != null)
                onBeforeRender();
        }

        internal static void Received(string condition, LogType type)
        {
            if (logMessageReceived != null)
                logMessageReceived(condition, "", type);
        }
    }

    public static class Time
    {
        public static float deltaTime { get; private set; }
        public static float unscaledDeltaTime { get; private set; }
        public static float timeScale = 1;
        public static float time { get; private set; }
        public static double timeAsDouble { get { return time; } }
        public static float realtimeSinceStartup { get; private set; }
        public static double realtimeSinceStartupAsDouble { get { return realtimeSinceStartup; } }
        public static int frameCount { get; private set; }

        internal static void Advance(float seconds)
        {
            unscaledDeltaTime = seconds;
            realtimeSinceStartup += seconds;
            deltaTime = timeScale * seconds;
            time += deltaTime;
            frameCount++;
        }
    }

    public static class Screen
    {
        public static int width { get { return 640; } }
        public static int height { get { return 480; } }
    }

    public enum ColorSpace { Uninitialized = -1, Gamma, Linear }

    public static class SystemInfo
    {
        static SystemInfo()
        {
            supportsComputeShaders = supportsIndirectArgumentsBuffer = true;
            maxComputeBufferInputsCompute = maxComputeBufferInputsVertex = 8;
            maxGraphicsBufferSize = 1L << 31;
            graphicsDeviceType = Rendering.GraphicsDeviceType.Vulkan;
        }

        public static bool supportsComputeShaders { get; internal set; }
        public static bool supportsIndirectArgumentsBuffer { get; internal set; }
        public static bool supportsGpuRecorder { get; internal set; }
        public static bool supportsMultiview { get; internal set; }
        public static int maxComputeBufferInputsCompute { get; internal set; }
        public static int maxComputeBufferInputsVertex { get; internal set; }
        public static int maxComputeWorkGroupSize { get { return 1024; } }
        public static int computeSubGroupSize { get { return 64; } }
        public static long maxGraphicsBufferSize { get; internal set; }
        public static int graphicsMemorySize { get { return 4096; } }
        public static Rendering.GraphicsDeviceType graphicsDeviceType { get; internal set; }
        public static string graphicsDeviceName { get { return "stand-in"; } }
        public static string graphicsDeviceVersion { get { return "stand-in"; } }
        public static string deviceModel { get { return "stand-in"; } }
        public static string operatingSystem { get { return "stand-in"; } }
    }
}

namespace UnityEngine.Events
{
    public delegate void UnityAction();
}

namespace UnityEngine.Rendering
{
    public enum GraphicsDeviceType { Direct3D11 = 2, Null = 4, OpenGLES3 = 11, Metal = 16, OpenGLCore = 17, Direct3D12 = 18, Vulkan = 21 }
}

namespace StandIns
{
    using UnityEngine;

    /// <summary>What was logged, and what a test may set that Unity keeps read-only. Not part of Unity's API.</summary>
    public static class Console
    {
        public static readonly List<KeyValuePair<LogType, string>> Lines = new List<KeyValuePair<LogType, string>>();

        public static int Count(LogType type)
        {
            int count = 0;
            foreach (KeyValuePair<LogType, string> line in Lines)
                count += line.Key == type ? 1 : 0;
            return count;
        }

        internal static void Write(LogType type, object message, UnityEngine.Object context)
        {
            string text = message == null ? "Null" : message.ToString();
            Lines.Add(new KeyValuePair<LogType, string>(type, text));
            Application.Received(text, type);
        }
    }

    public static class Machine
    {
        /// <summary>The exit code that the player was given; null while it runs on.</summary>
        public static int? ExitCode { get; internal set; }

        public static void Paths(string streamingAssets, string persistentData)
        {
            Application.streamingAssetsPath = streamingAssets;
            Application.persistentDataPath = persistentData;
        }

        /// <summary>How often Resources.Load was called.</summary>
        public static int Asked { get { return Resources.Asked; } }

        /// <summary>Put an asset where Resources.Load finds it.</summary>
        public static void Place(string path, UnityEngine.Object asset) { Resources.Placed[path] = asset; }

        public static void Platform(RuntimePlatform platform) { Application.platform = platform; }
        public static void Playing(bool playing) { Application.isPlaying = playing; }
        public static void ComputeShaders(bool supported) { SystemInfo.supportsComputeShaders = supported; }
        public static void IndirectArguments(bool supported) { SystemInfo.supportsIndirectArgumentsBuffer = supported; }
        public static void ComputeBuffers(int most) { SystemInfo.maxComputeBufferInputsCompute = most; }
        public static void VertexBuffers(int most) { SystemInfo.maxComputeBufferInputsVertex = most; }
        public static void GraphicsDevice(UnityEngine.Rendering.GraphicsDeviceType type) { SystemInfo.graphicsDeviceType = type; }
        public static void BufferSize(long most) { SystemInfo.maxGraphicsBufferSize = most; }
        public static void GpuRecorder(bool supported) { SystemInfo.supportsGpuRecorder = supported; }
        public static void Multiview(bool supported) { SystemInfo.supportsMultiview = supported; }
    }
}
