using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("Mua.Samples.VrPlayer.Editor")]
