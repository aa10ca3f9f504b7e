// Stand-in. Source: Unity 6000.0 scripting reference, UnityWebRequest. It reads files; a frame passes first.
using System;
using System.IO;

namespace UnityEngine.Networking
{
    public class DownloadHandler
    {
        public byte[] data { get; internal set; }
    }

    public sealed class UnityWebRequestAsyncOperation : AsyncOperation
    {
        internal UnityWebRequest Request;

        public override bool isDone { get { return Request.isDone; } }
    }

    public sealed class UnityWebRequest : IDisposable
    {
        public enum Result { InProgress, Success, ConnectionError, ProtocolError, DataProcessingError }

        private const string Scheme = "jar:file://"; // of what lies in an Android package

        private readonly int asked = Time.frameCount;
        private bool done;
        private Result outcome;

        private UnityWebRequest(string url)
        {
            this.url = url;
            downloadHandler = new DownloadHandler();
            StandIns.Requests.Open++;
        }

        public string url { get; private set; }
        public string error { get; private set; }
        public Result result { get { return isDone ? outcome : Result.InProgress; } }
        public DownloadHandler downloadHandler { get; private set; }

        public bool isDone
        {
            get
            {
                if (!done && Time.frameCount > asked)
                    Finish();
                return done;
            }
        }

        public static UnityWebRequest Get(string uri) { return new UnityWebRequest(uri.StartsWith(Scheme) ? uri : new Uri(uri).AbsoluteUri); }
        public UnityWebRequestAsyncOperation SendWebRequest() { return new UnityWebRequestAsyncOperation { Request = this }; }
        public void Abort() { done = true; outcome = Result.ConnectionError; error = "Request aborted"; }
        public void Dispose() { StandIns.Requests.Open -= done ? 1 : 0; } // one in progress goes on until it is aborted

        private void Finish()
        {
            done = true;
            string path = url.StartsWith(Scheme, StringComparison.Ordinal) ? url.Substring(Scheme.Length) : "";
            bool there = File.Exists(path);
            outcome = there ? Result.Success : Result.ProtocolError;
            error = there ? null : "HTTP/1.1 404 Not Found";
            downloadHandler.data = there ? File.ReadAllBytes(path) : null;
        }
    }
}

namespace StandIns
{
    /// <summary>Requests that were made and not disposed of. Not part of Unity's API.</summary>
    public static class Requests
    {
        public static int Open;
    }
}
