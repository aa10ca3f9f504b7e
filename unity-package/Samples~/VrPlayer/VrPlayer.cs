using System;
using System.Collections;
using UnityEngine;

namespace Mua.Samples.VrPlayer
{
    /// <summary>
    /// Shows the avatars that it finds, one at a time, to a user with a headset or with keyboard and mouse. PlayerScene makes a
    /// scene around it.
    /// </summary>
    [DisallowMultipleComponent]
    public sealed class VrPlayer : MonoBehaviour
    {
        [SerializeField] private AvatarRenderer shown = null;
        [SerializeField] private HeadPose head = null;
        [SerializeField] private TextMesh panel = null;
        [SerializeField] private GameObject help = null;

        [SerializeField, Tooltip("Imported avatars, listed after the files that the player finds.")]
        private AvatarAsset[] avatars = new AvatarAsset[0];

        [SerializeField, Tooltip("Display refresh rate of the headset in Hz: 72 or 90. Needs com.unity.xr.meta-openxr.")]
        private float displayRate = 72;

        [SerializeField, Range(0, 1)]
        [Tooltip("Foveated rendering on a headset: 0 draws everything at full resolution, 1 saves the most.")]
        private float foveation = 0.5f;

        private readonly AvatarShelf shelf = new AvatarShelf();
        private readonly HeadsetInput headset = new HeadsetInput();
        private readonly DesktopInput desktop = new DesktopInput();
        private PlayerControls controls;
        private StatusPanel status;
        private string message = "";

        /// <summary>Objects that PlayerScene made.</summary>
        internal void Connect(
            AvatarRenderer shown, HeadPose head, TextMesh panel, GameObject help, AvatarAsset[] avatars)
        {
            this.shown = shown;
            this.head = head;
            this.panel = panel;
            this.help = help;
            this.avatars = avatars;
        }

        private void Start()
        {
            var rig = new PlayerRig(transform, head.GetComponent<Camera>());
            controls = new PlayerControls(shown, rig, head, help);
            status = new StatusPanel(panel, shown, shelf, new HeadsetDisplay(displayRate, foveation));
            StartCoroutine(Open());
        }

        private IEnumerator Open()
        {
            yield return shelf.Fill(avatars);
            if (shelf.Count == 0)
            {
                message = "No avatar was found. Put files like hero.muaavatar in " + AvatarShelf.Folder + " and start again.";
            }
            else
            {
                FindAsked();
                Show();
            }
        }

        /// <summary>Begins with the avatar that mua-deploy asks for.</summary>
        private void FindAsked()
        {
            string[] words = Environment.GetCommandLineArgs();
            int at = Math.Max(Array.IndexOf(words, "-muaAvatar"), Array.IndexOf(words, "-muaBench"));
            if (at >= 0 && at + 1 < words.Length && !shelf.Find(words[at + 1]))
            {
                message = "No avatar is called " + words[at + 1] + ".";
            }
        }

        private void OnDestroy()
        {
            status?.Dispose();
        }

        private void Update()
        {
            var intents = new PlayerIntents();
            headset.Read(ref intents);
            desktop.Read(ref intents);
            controls.Apply(intents, Time.unscaledDeltaTime);
            Choose(intents.Pressed);
            if (shown.State == AvatarState.Failed && shelf.Current != null && !shelf.Current.HasFailed)
            {
                GoOn();
            }
            status.Count(Time.unscaledDeltaTime, message);
        }

        private void Choose(PlayerAction pressed)
        {
            int by = (pressed & PlayerAction.NextAvatar) != 0 ? 1 : (pressed & PlayerAction.PreviousAvatar) != 0 ? -1 : 0;
            if (by == 0 || shelf.Count == 0)
            {
                return;
            }
            AvatarEntry before = shelf.Current;
            shelf.Step(by);
            if (shelf.Current != before)
            {
                message = "";
                Show();
            }
        }

        /// <summary>Says why the present avatar cannot be shown, and tries the next.</summary>
        private void GoOn()
        {
            message = shown.Message;
            if (shelf.Skip())
            {
                Show();
            }
        }

        private void Show()
        {
            AvatarEntry entry = shelf.Current;
            if (entry.Asset != null)
            {
                shown.Load(entry.Asset);
            }
            else
            {
                shown.Load(entry.Path);
            }
        }
    }
}
