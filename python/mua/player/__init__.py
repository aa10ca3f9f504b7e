"""Plays avatars on a Vulkan device: the same dispatches in the same order as the Unity package's frames."""
