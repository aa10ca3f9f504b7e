"""A built-in range of motion, made for a rig: what its joints can do, beside the clips that a user has.

A person moves as `moves` writes it down in angles of a body of its own, and through random plausible poses; the clips
are put on the rig as any motion is. A rig that is no person moves each joint for itself. `motion_range` makes it.
"""

from mua.motion.range.make import motion_range, standing

__all__ = ["motion_range", "standing"]
