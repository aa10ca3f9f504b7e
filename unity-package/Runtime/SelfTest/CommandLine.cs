using System;

namespace Mua.SelfTest
{
    /// <summary>What mua-deploy told the player (docs/deploy.md).</summary>
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

        /// <summary>What answers carry.</summary>
        public string Run => After("-muaRun") ?? DefaultRun;

        private string After(string word)
        {
            int at = Array.IndexOf(words, word);
            return at >= 0 && at + 1 < words.Length ? words[at + 1] : null;
        }
    }
}
