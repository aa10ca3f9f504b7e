using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using UnityEditor;
using UnityEditor.PackageManager;
using UnityEditor.PackageManager.Requests;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>
    /// Packages that a headset needs and that com.mua.avatar does not bring: which are absent, and adding them. Adding
    /// compiles scripts anew, so that what comes after is for the next load of the editor's scripts.
    /// </summary>
    internal static class ProjectPackages
    {
        private const string WaitingKey = "Mua.ProjectSetup.Waiting"; // for one session of the editor
        private const int PatienceSeconds = 600;
        private const int PollMilliseconds = 50;

        private static AddAndRemoveRequest request; // of a menu; one at a time

        /// <summary>Names of the packages that are absent or too old.</summary>
        public static IReadOnlyList<string> Missing()
        {
            var names = new List<string>();
#if !MUA_XR_MANAGEMENT
            names.Add("com.unity.xr.management");
#endif
#if !MUA_OPENXR
            names.Add("com.unity.xr.openxr");
#endif
#if !MUA_URP
            if (ProjectGraphics.TakesUrp())
            {
                names.Add("com.unity.render-pipelines.universal");
            }
#endif
            return names;
        }

        public static string HowToAdd(string name)
        {
            return $"Package {name} is absent or too old: set the project up from the menu MUA, or install it by name in the "
                + "Package Manager";
        }

        /// <summary>Adds packages and waits for them, for batch mode.</summary>
        public static ProjectOutcome Add(IReadOnlyList<string> names)
        {
            AddAndRemoveRequest adding = Client.AddAndRemove(names.ToArray());
            DateTime end = DateTime.UtcNow.AddSeconds(PatienceSeconds);
            while (!adding.IsCompleted && DateTime.UtcNow < end)
            {
                Thread.Sleep(PollMilliseconds);
            }
            if (!adding.IsCompleted || adding.Status == StatusCode.Failure)
            {
                Debug.LogError($"MUA-BUILD FAIL {Failure(adding, names)}");
                return ProjectOutcome.Failed;
            }
            Debug.Log($"MUA-BUILD AGAIN added {string.Join(", ", names)}");
            return ProjectOutcome.Again;
        }

        /// <summary>Adds packages where the user agrees; set-up for `target` goes on once they are there.</summary>
        public static ProjectOutcome Ask(IReadOnlyList<string> names, BuildTarget target)
        {
            string list = string.Join("\n", names);
            string question = $"The headset needs packages that are not in this project:\n\n{list}\n\nAdd them?";
            if (!EditorUtility.DisplayDialog("MUA", question, "Add", "Cancel"))
            {
                foreach (string name in names)
                {
                    Debug.LogWarning($"MUA: {HowToAdd(name)}");
                }
                return ProjectOutcome.Failed;
            }
            SessionState.SetInt(WaitingKey, (int)target);
            request = Client.AddAndRemove(names.ToArray());
            EditorApplication.update += Poll;
            return ProjectOutcome.Again;
        }

        /// <summary>Whether packages that set-up waited for are there now; asked once a load of scripts.</summary>
        public static bool HasWaited(out BuildTarget target)
        {
            target = (BuildTarget)SessionState.GetInt(WaitingKey, 0);
            if (target == 0 || Missing().Count > 0)
            {
                return false;
            }
            SessionState.EraseInt(WaitingKey);
            return true;
        }

        private static void Poll()
        {
            if (!request.IsCompleted)
            {
                return;
            }
            EditorApplication.update -= Poll;
            if (request.Status == StatusCode.Failure)
            {
                SessionState.EraseInt(WaitingKey);
                Debug.LogError($"MUA: {Failure(request, Missing())}");
            }
            request = null;
        }

        private static string Failure(AddAndRemoveRequest adding, IReadOnlyList<string> names)
        {
            string why = adding.Error == null ? $"no answer in {PatienceSeconds} s" : adding.Error.message;
            return $"Packages {string.Join(", ", names)} could not be added: {why}";
        }
    }
}
