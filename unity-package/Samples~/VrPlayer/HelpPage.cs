namespace Mua.Samples.VrPlayer
{
    /// <summary>What the buttons do, as the scene shows it; README.md has the same as a table.</summary>
    internal static class HelpPage
    {
        public const string Text =
            "CONTROLLERS\n"
            + "left stick   walk\n"
            + "right stick   turn the avatar, zoom\n"
            + "right grip + stick   scrub\n"
            + "A   play, pause        B   next clip\n"
            + "right, left trigger   next, previous frame\n"
            + "Y, X   next, previous avatar\n"
            + "left grip + A B X Y right trigger\n"
            + "     splats geometry mesh skeleton shadow\n"
            + "left grip + left trigger   previous clip\n"
            + "right stick pressed   back to the start\n"
            + "menu, left stick pressed   hide this\n\n"
            + "KEYBOARD AND MOUSE\n"
            + "W A S D   walk        R F   up, down\n"
            + "right mouse button   look\n"
            + "Q E   turn        wheel, up, down   zoom\n"
            + "left, right   scrub        space   play, pause\n"
            + ". ,   frame     ] [   clip     page down, up   avatar\n"
            + "1 2 3 4 5   splats geometry mesh skeleton shadow\n"
            + "backspace   back to the start     H   hide this";
    }
}
