"""Files and folders: written atomically, locked, looked for, identified by their first bytes."""
