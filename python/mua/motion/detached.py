"""Joints of a character that nothing moves and that hang on no moved joint: the trunk has to take them along."""

from mua.motion.rest_alignment import Rest

TRUNK = ("hips", "spine")


def detached_joints(rest: Rest) -> dict[int, int]:
    """The topmost detached joints of the target, each with the joint of hips and spine that is nearest to it at rest.

    Joints on the way from the root to a matched joint are none: where they stand, all others do.
    """
    target, chains = rest.target, rest.matches.chains
    trunk = [joint for role in TRUNK for joint in rest.matches.roles.get(role, ()) if joint in chains]
    if not trunk:
        return {}
    carrying = {above for joint in chains for above in target.ancestors(joint)}
    moved = carrying | set(chains)
    detached: dict[int, int] = {}
    for joint, parent in enumerate(target.parents.tolist()):
        if joint not in moved and parent in carrying and not {parent, *target.ancestors(parent)} & set(chains):
            detached[joint] = min(trunk, key=lambda j: float(((rest.target_at[j] - rest.target_at[joint]) ** 2).sum()))
    return detached
