using System;
using System.Collections;
using System.Globalization;
using System.IO;
using UnityEngine;

namespace Mua.SelfTest
{
    /// <summary>Plays one avatar for some seconds, alone; the log says when, bench.json what its frames took.</summary>
    internal sealed class Bench
    {
        private const string Mark = "MUA-BENCH";
        private const string Report = "bench.json";
        private const float SceneSeconds = 1; // in which a scene may show the avatar by itself
        private const float LoadSeconds = 45; // mua-deploy gives up after 60 without an answer
        private const float WarmSeconds = 2;
        private const float MostSeconds = 3600;
        private const float Distance = 2; // metres from the camera to the middle of the avatar

        private readonly RunLog log;
        private readonly string avatar;
        private readonly string seconds;
        private AvatarRenderer shown;

        /// <summary>`avatar`: stem of a file in persistentDataPath/avatars; `seconds` as on the command line.</summary>
        public Bench(string run, string avatar, string seconds)
        {
            log = new RunLog(Mark, run);
            this.avatar = avatar;
            this.seconds = seconds;
        }

        /// <summary>Whether it was measured.</summary>
        public bool IsDone { get; private set; }

        private string AvatarPath => "avatars/" + avatar + ".muaavatar";

        /// <summary>A coroutine; it logs START and END, or FAIL.</summary>
        public IEnumerator Run()
        {
            RunLog.SayDevice();
            if (!float.TryParse(seconds, NumberStyles.Float, CultureInfo.InvariantCulture, out float length)
                || !(length > 0 && length <= MostSeconds))
            {
                log.Say("FAIL -muaSeconds is " + (seconds ?? "missing") + ", expected a number up to " + MostSeconds);
                yield break;
            }
            float begun = Time.realtimeSinceStartup;
            while (Time.realtimeSinceStartup - begun < SceneSeconds)
            {
                yield return null;
            }
            Show();
            while (IsLoading && Time.realtimeSinceStartup - begun < LoadSeconds)
            {
                yield return null;
            }
            if (IsReady)
            {
                yield return Centre();
            }
            begun = Time.realtimeSinceStartup;
            while (IsReady && Time.realtimeSinceStartup - begun < WarmSeconds)
            {
                yield return null;
            }
            if (!IsReady)
            {
                log.Say("FAIL " + Problem());
                yield break;
            }
            using (var frames = new FrameTimes(length))
            {
                log.Say("START " + avatar);
                begun = Time.realtimeSinceStartup;
                while (IsReady && Time.realtimeSinceStartup - begun < length)
                {
                    yield return null;
                    frames.Add();
                }
                IsDone = IsReady;
                log.Say(IsDone ? "END" : "FAIL " + Problem());
                if (IsDone)
                {
                    Write(frames);
                }
            }
        }

        private bool IsLoading => shown != null && shown.State == AvatarState.Loading;

        private bool IsReady => shown != null && shown.State == AvatarState.Ready;

        /// <summary>The scene's own renderer of the avatar, or a new one; all others are switched off.</summary>
        private void Show()
        {
            foreach (AvatarRenderer found in AvatarRenderer.All())
            {
                if (shown == null && found.isActiveAndEnabled && found.Shows(avatar))
                {
                    shown = found;
                }
                else
                {
                    found.enabled = false;
                }
            }
            if (shown == null)
            {
                shown = new GameObject("MUA bench").AddComponent<AvatarRenderer>();
                shown.Load(AvatarPath);
            }
            shown.ClipIndex = 0;
            shown.Speed = 1;
            shown.IsPlaying = true;
        }

        /// <summary>
        /// Turns the avatar's face to the camera and brings its middle before it, wherever the headset lies: a coroutine,
        /// as the box of another pose is there a frame later.
        /// </summary>
        private IEnumerator Centre()
        {
            Transform eye = Eye().transform;
            Vector3 ahead = eye.forward, level = new Vector3(ahead.x, 0, ahead.z);
            shown.transform.rotation = Quaternion.LookRotation(level.sqrMagnitude > 0 ? -level : Vector3.back);
            yield return null;
            yield return null;
            if (IsReady)
            {
                shown.transform.position += eye.position + Distance * ahead - shown.Bounds.center;
            }
        }

        private static Camera Eye()
        {
            Camera camera = Camera.main;
            if (camera == null)
            {
                camera = UnityEngine.Object.FindAnyObjectByType<Camera>();
            }
            return camera != null ? camera : new GameObject("MUA camera").AddComponent<Camera>();
        }

        private string Problem()
        {
            if (shown == null)
            {
                return "the scene has destroyed the avatar " + avatar;
            }
            if (shown.State == AvatarState.Loading)
            {
                return avatar + " is still loading after " + LoadSeconds + " seconds";
            }
            return shown.Message.Length > 0 ? shown.Message : avatar + " is not shown any more";
        }

        private void Write(FrameTimes frames)
        {
            string path = Path.Combine(Application.persistentDataPath, Report), part = path + ".part";
            try
            {
                File.WriteAllText(part, JsonUtility.ToJson(frames.Report(avatar, RunLog.Device()), true));
                File.Delete(path);
                File.Move(part, path);
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                Debug.LogWarning("MUA: " + path + " could not be written: " + error.Message);
            }
        }
    }
}
