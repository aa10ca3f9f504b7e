using UnityEngine;

namespace Mua.SelfTest
{
    /// <summary>Answers to mua-deploy: a line each, with the mark and the run (docs/deploy.md).</summary>
    internal sealed class RunLog
    {
        private readonly string begin;

        public RunLog(string mark, string run)
        {
            begin = mark + " " + run + " ";
        }

        public void Say(string text)
        {
            Write(begin + OneLine(text));
        }

        /// <summary>Logs on which machine figures were taken; not an answer to mua-deploy.</summary>
        public static void SayDevice()
        {
            Write("MUA device: " + Device());
        }

        /// <summary>Model, graphics and the limits that matter, in a line.</summary>
        public static string Device()
        {
            return OneLine(
                SystemInfo.deviceModel + "; " + SystemInfo.operatingSystem + "; Unity " + Application.unityVersion
                + "; " + SystemInfo.graphicsDeviceName + "; " + SystemInfo.graphicsDeviceType + "; "
                + SystemInfo.graphicsDeviceVersion + "; " + SystemInfo.graphicsMemorySize + " MB; buffers of a kernel "
                + SystemInfo.maxComputeBufferInputsCompute + ", of a vertex shader "
                + SystemInfo.maxComputeBufferInputsVertex + "; threads of a group " + SystemInfo.maxComputeWorkGroupSize
                + "; threads of a wave " + SystemInfo.computeSubGroupSize + "; bytes of a buffer "
                + SystemInfo.maxGraphicsBufferSize);
        }

        private static void Write(string line)
        {
            // A stack trace behind each line would push others out of the device's log.
            Debug.LogFormat(LogType.Log, LogOption.NoStacktrace, null, "{0}", line);
        }

        private static string OneLine(string text)
        {
            return text.Replace('\r', ' ').Replace('\n', ' ');
        }
    }
}
