namespace Mua.Samples.VrPlayer
{
    /// <summary>All devices as one: what any of them asks for counts.</summary>
    internal sealed class PlayerInput
    {
        private readonly HeadsetInput headset = new HeadsetInput();
        private readonly DesktopInput desktop = new DesktopInput();

        /// <summary>Of this frame; call it once in each.</summary>
        public PlayerIntents Read()
        {
            var intents = new PlayerIntents();
            headset.Read(ref intents);
            desktop.Read(ref intents);
            return intents;
        }
    }
}
