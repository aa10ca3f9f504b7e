"""Files and folders: written atomically, locked, looked for, told apart by their first bytes."""
