// Stand-in. Test assemblies name it as the test framework's manual asks; none uses it.
