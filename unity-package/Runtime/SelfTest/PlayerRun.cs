using System;
using System.Collections;
using UnityEngine;

namespace Mua.SelfTest
{
    /// <summary>Starts in a player what its command line asks for: the self-test or a bench.</summary>
    internal sealed class PlayerRun : MonoBehaviour
    {
        /// <summary>Of the command line; null where it asks for nothing.</summary>
        public static PlayerRun Begin(string[] words)
        {
            var line = new CommandLine(words);
            if (!line.IsSelfTest && line.Bench == null)
            {
                return null;
            }
            var place = new GameObject("MUA run");
            DontDestroyOnLoad(place);
            var run = place.AddComponent<PlayerRun>();
            run.StartCoroutine(run.Go(line));
            return run;
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.AfterSceneLoad)]
        private static void BeginOnLoad()
        {
            if (!Application.isEditor)
            {
                Begin(Environment.GetCommandLineArgs());
            }
        }

        private IEnumerator Go(CommandLine line)
        {
            bool isRight = true;
            if (line.IsSelfTest)
            {
                var test = new SelfTestRun(line.Run, GoldenFolder.InPlayer, false);
                yield return test.Run();
                isRight = test.HasPassed;
            }
            if (line.Bench != null)
            {
                var bench = new Bench(line.Run, line.Bench, line.Seconds);
                yield return bench.Run();
                isRight &= bench.IsDone;
            }
            Destroy(gameObject);
            if (Application.isBatchMode)
            {
                Application.Quit(isRight ? 0 : 1); // a person sees the scene go on; a script waits for an exit code
            }
        }
    }
}
