"""What a likeness says in words and numbers."""

from typing import Any

from mua.likeness.compare import Likeness, PoseLikeness, Shot

GOOD_IOU = 0.97
GOOD_PSNR = 30.0  # decibels


def summary(likeness: Likeness) -> str:
    """The figures in a sentence."""
    return (
        f"Splats beside the source: silhouettes overlap by {100 * likeness.iou:.1f} %, colours inside differ "
        f"by {likeness.psnr:.1f} dB in the worst of {len(likeness.poses)} poses."
    )


def sentences(likeness: Likeness) -> tuple[str, ...]:
    """What is poor, a sentence each; none where all is well."""
    told = []
    least = min(likeness.poses, key=lambda pose: pose.agreement.iou)
    if least.agreement.iou < GOOD_IOU:
        told.append(
            f"The splats' silhouette overlaps the character's by {100 * least.agreement.iou:.1f} % in the pose "
            f"{least.pose!r}: {_excess(least)}; it is worst at {_where(least.worst)}."
        )
    least = min(likeness.poses, key=lambda pose: pose.agreement.psnr)
    if least.agreement.psnr < GOOD_PSNR:
        told.append(
            f"The splats' colours differ from the character's by {least.agreement.psnr:.1f} dB in the pose "
            f"{least.pose!r} ({GOOD_PSNR:.0f} dB and more look alike); it is worst at {_where(least.worst)}."
        )
    return tuple(told)


def as_dict(likeness: Likeness) -> dict[str, Any]:
    """Every figure, for a JSON file."""
    worst = likeness.worst
    return {
        "iou": likeness.iou,
        "psnr": likeness.psnr,
        "worst": {"pose": worst.pose, **_place(worst.worst)},
        "poses": [
            {
                "pose": pose.pose,
                "iou": pose.agreement.iou,
                "psnr": pose.agreement.psnr,
                "views": [
                    {"iou": shot.agreement.iou, "psnr": shot.agreement.psnr, **_place(shot)} for shot in pose.shots
                ],
            }
            for pose in likeness.poses
        ],
    }


def _place(shot: Shot) -> dict[str, Any]:
    column, row = shot.place
    return {"view": shot.view, "joint": shot.joint, "column": column, "row": row, "difference": shot.difference}


def _where(shot: Shot) -> str:
    return f"{shot.joint}, seen from {shot.view}"


def _excess(pose: PoseLikeness) -> str:
    """Whether splats are missing or stand out."""
    seen = pose.agreement
    missing, beyond = (100 * n / max(seen.common + seen.missing, 1) for n in (seen.missing, seen.beyond))
    return f"{beyond:.1f} % of its area is added outside and {missing:.1f} % is missing inside"
