using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("Mua.Avatar.Urp")]
[assembly: InternalsVisibleTo("Mua.Avatar.Timeline")]
[assembly: InternalsVisibleTo("Mua.Avatar.Editor")]
[assembly: InternalsVisibleTo("Mua.Avatar.SelfTest")]
[assembly: InternalsVisibleTo("Mua.Avatar.Tests")]
[assembly: InternalsVisibleTo("Mua.Avatar.Editor.Tests")]
