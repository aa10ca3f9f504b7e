"""The comparison of splats with their source as sentences and numbers."""

from math import floor
from typing import Any

from mua.arguments import amount
from mua.fidelity.compare import Fidelity, PoseFidelity, Shot
from mua.fidelity.faces import LOST, LOST_OVERLAP, FaceFidelity
from mua.fidelity.measure import Agreement

GOOD_IOU = 0.97
GOOD_PSNR = 30.0  # decibels
SHOWN = 8  # expressions that a sentence names


def summary(fidelity: Fidelity) -> str:
    """The figures in a sentence."""
    return (
        f"Splats compared with the source: silhouettes overlap by {100 * fidelity.iou:.1f} %, the colours inside have "
        f"a PSNR of {fidelity.psnr:.1f} dB, in the worst of {amount(len(fidelity.poses), 'pose')}."
    )


def sentences(fidelity: Fidelity) -> tuple[str, ...]:
    """A sentence for each poor figure; none if all are good."""
    found = []
    least = min(fidelity.poses, key=lambda pose: pose.agreement.iou)
    if least.agreement.iou < GOOD_IOU:
        found.append(
            f"The silhouettes of splats and character overlap by only {_below(100 * least.agreement.iou)} % in the "
            f"pose {least.pose!r}: {_excess(least)}; worst at {_where(least.worst)}."
        )
    least = min(fidelity.poses, key=lambda pose: pose.agreement.psnr)
    if least.agreement.psnr < GOOD_PSNR:
        found.append(
            f"The colours of splats and character have a PSNR of only {_below(least.agreement.psnr)} dB in the pose "
            f"{least.pose!r} (from {GOOD_PSNR:.0f} dB on they look alike); worst at {_where(least.worst)}."
        )
    return (*found, *_face_sentences(fidelity.face))


def _face_sentences(face: FaceFidelity | None) -> tuple[str, ...]:
    """A sentence on expressions in which the face is less like its source than at rest."""
    if face is None:
        return ()
    rest = face.rest.agreement
    poor = [shot for shot in face.expressions if _is_poor(shot.agreement, rest)]
    if not poor:
        return ()
    poor.sort(key=lambda shot: shot.agreement.psnr)
    named = ", ".join(_figures(shot.name, shot.agreement) for shot in poor[:SHOWN])
    more = f" and {len(poor) - SHOWN} more" if len(poor) > SHOWN else ""
    return (f"The face is less like the character than at rest ({_figures('', rest)}) in: {named}{more}.",)


def _is_poor(found: Agreement, rest: Agreement) -> bool:
    return found.psnr < min(rest.psnr - LOST, GOOD_PSNR) or found.iou < min(rest.iou - LOST_OVERLAP, GOOD_IOU)


def _figures(name: str, found: Agreement) -> str:
    return f"{name} {100 * found.iou:.1f} %, {found.psnr:.1f} dB".lstrip()


def _face(face: FaceFidelity | None) -> dict[str, dict[str, float]]:
    """The figures of the face at rest and in each expression; none without expressions."""
    shots = () if face is None else (face.rest, *face.expressions)
    return {shot.name: {"iou": shot.agreement.iou, "psnr": shot.agreement.psnr} for shot in shots}


def as_dict(fidelity: Fidelity) -> dict[str, Any]:
    """Every figure, for a JSON file."""
    worst = fidelity.worst
    return {
        "iou": fidelity.iou,
        "psnr": fidelity.psnr,
        "expressions": _face(fidelity.face),
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
            for pose in fidelity.poses
        ],
    }


def _place(shot: Shot) -> dict[str, Any]:
    column, row = shot.place
    return {"view": shot.view, "joint": shot.joint, "column": column, "row": row, "difference": shot.difference}


def _below(figure: float) -> str:
    """A figure rounded down, so that one below a limit never reads as the limit."""
    return f"{floor(10 * figure) / 10:.1f}"


def _where(shot: Shot) -> str:
    return f"{shot.joint}, seen from {shot.view}"


def _excess(pose: PoseFidelity) -> str:
    """How much of the area sticks out, and how much is missing."""
    seen = pose.agreement
    missing, beyond = (100 * n / max(seen.common + seen.missing, 1) for n in (seen.missing, seen.beyond))
    return f"{beyond:.1f} % of its area stick out and {missing:.1f} % are missing"
