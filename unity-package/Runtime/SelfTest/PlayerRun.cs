using System;
using System.Collections;
using UnityEngine;

namespace Mua.SelfTest
{
    /// <summary>Starts in a player what its command line asks for: the self-test or a bench.</summary>
    internal sealed class PlayerRun : MonoBehaviour
    {
        /// <summary>The run that the command line asks for; null where it asks for none.</summary>
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
                var test = new SelfTestRun(line.Run, GoldenFolder.InPlayer);
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

    /// <summary>Arguments that mua-deploy gives the player (docs/deploy.md).</summary>
    internal sealed class CommandLine
    {
        private const string DefaultRun = "00000000"; // for people who start the player by hand

        private readonly string[] words;

        public CommandLine(string[] words)
        {
            this.words = words;
        }

        public bool IsSelfTest => Array.IndexOf(words, "-muaSelfTest") >= 0;

        /// <summary>The avatar to measure; null where none is.</summary>
        public string Bench => After("-muaBench");

        /// <summary>How long to measure, as written; null where it is left out.</summary>
        public string Seconds => After("-muaSeconds");

        /// <summary>The name of the run, which every answer repeats.</summary>
        public string Run => After("-muaRun") ?? DefaultRun;

        private string After(string word)
        {
            int at = Array.IndexOf(words, word);
            return at >= 0 && at + 1 < words.Length ? words[at + 1] : null;
        }
    }
}
