using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("Mua.Avatar.Editor.Tests")]
