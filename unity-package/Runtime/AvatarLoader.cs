using System;
using System.IO;
using System.Threading.Tasks;
using Mua.Format;
using Unity.Profiling;
using UnityEngine;
using UnityEngine.Networking;

namespace Mua
{
    /// <summary>
    /// Brings one avatar from its bytes to the device. Reading and checking run on another thread, the upload goes in
    /// chunks, so that no frame waits. Until Continue is done, everything belongs to the loader, and Dispose gives it back.
    /// </summary>
    internal sealed class AvatarLoader : IDisposable
    {
        private const int ChunkBytes = 4 << 20; // of one frame
        private const float ReadShare = 0.3f; // of Progress, up to the upload

        private static readonly ProfilerMarker UploadMarker = new ProfilerMarker("MUA upload");

        private UnityWebRequest request; // of a file inside an Android package
        private Task<AvatarBuffers> reading;
        private AvatarBuffers buffers;

        private AvatarLoader(string source)
        {
            Source = source;
        }

        /// <summary>What is loaded, for messages.</summary>
        public string Source { get; }

        /// <summary>From 0 to 1.</summary>
        public float Progress => buffers == null ? 0 : ReadShare + (1 - ReadShare) * buffers.Progress;

        public static AvatarLoader Of(AvatarAsset asset)
        {
            var loader = new AvatarLoader(asset.name);
            byte[] content = asset.Content;
            string fault = asset.Fault;
            loader.reading = fault.Length > 0
                ? Task.FromException<AvatarBuffers>(new InvalidOperationException(fault))
                : Task.Run(() => Read(content));
            return loader;
        }

        /// <summary>
        /// A file by its address or full path, or by its path in persistentDataPath or else in StreamingAssets. ArgumentException
        /// or InvalidOperationException where it is none.
        /// </summary>
        public static AvatarLoader Of(string file)
        {
            string path = Locate(file);
            var loader = new AvatarLoader(path);
            if (path.Contains("://"))
            {
                loader.request = Request(path);
                loader.request.SendWebRequest();
            }
            else
            {
                loader.reading = Task.Run(() => Read(File.ReadAllBytes(path)));
            }
            return loader;
        }

        /// <summary>
        /// A frame's share of the work; whether all is on the device. Errors: AvatarFormatException, IOException or
        /// InvalidOperationException with the sentence for the user.
        /// </summary>
        public bool Continue()
        {
            if (request != null && !ContinueRequest())
            {
                return false;
            }
            if (buffers == null && !ContinueReading())
            {
                return false;
            }
            using (UploadMarker.Auto())
            {
                return buffers.Upload(ChunkBytes);
            }
        }

        /// <summary>All of it at once, for an editor that does not play.</summary>
        public void Finish()
        {
            while (!Continue())
            {
                if (reading != null && !reading.IsFaulted)
                {
                    Task.WaitAny(reading); // Wait would wrap what was wrong in an exception of its own
                }
            }
        }

        /// <summary>Hands over what Continue has loaded.</summary>
        public AvatarBuffers Take()
        {
            AvatarBuffers taken = buffers;
            buffers = null;
            return taken;
        }

        public void Dispose()
        {
            if (request != null)
            {
                request.Abort();
                request.Dispose();
                request = null;
            }
            if (buffers != null)
            {
                buffers.Dispose();
                buffers = null;
            }
            reading = null; // what it makes holds no GPU memory
        }

        private bool ContinueRequest()
        {
            if (!request.isDone)
            {
                return false;
            }
            UnityWebRequest finished = request;
            request = null;
            using (finished)
            {
                if (finished.result != UnityWebRequest.Result.Success)
                {
                    throw new IOException(finished.error);
                }
                byte[] content = finished.downloadHandler.data;
                reading = Task.Run(() => Read(content));
            }
            return true;
        }

        private bool ContinueReading()
        {
            if (!reading.IsCompleted)
            {
                return false;
            }
            if (reading.IsFaulted)
            {
                throw reading.Exception.GetBaseException();
            }
            buffers = reading.Result;
            reading = null;
            return true;
        }

        private static UnityWebRequest Request(string address)
        {
            try
            {
                return UnityWebRequest.Get(address);
            }
            catch (FormatException error)
            {
                throw new InvalidOperationException(address + " is no address: " + error.Message);
            }
        }

        private static AvatarBuffers Read(byte[] content)
        {
            return new AvatarBuffers(AvatarFile.Read(content));
        }

        private static string Locate(string file)
        {
            if (Path.IsPathRooted(file) || file.Contains("://"))
            {
                return file;
            }
            string persistent = Path.Combine(Application.persistentDataPath, file);
            return File.Exists(persistent) ? persistent : Application.streamingAssetsPath + "/" + file;
        }
    }
}
