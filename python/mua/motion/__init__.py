"""Motion from files, and its retargeting to a character's skeleton."""
