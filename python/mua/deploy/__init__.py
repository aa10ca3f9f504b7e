"""Puts the player and avatars on a headset through adb, tests and measures them there: docs/deploy.md."""
