"""The comparison that mua-eval makes with the pictures of a capture, once its options are known to be good."""

from mua.capture import open_capture
from mua.cli.console import printer
from mua.cli.display import Display
from mua.compare import filmed, filmed_report
from mua.compare.order import EvaluationOrder
from mua.files import replacing, write_bytes
from mua.splatting.perceptual import Lpips


def compare(order: EvaluationOrder) -> None:
    """Carry out an order whose recording is the folder of a capture, and write and print what comes of it."""
    capture = open_capture(order.recording)
    lpips = Lpips(order.lpips_weights) if order.lpips_weights is not None else None
    entries = {} if order.teacher is None else filmed.teacher_entries(order.teacher)
    joints = capture.surfaces.skeleton.names
    entries |= {path.stem: filmed.avatar_entry(path, joints) for path in order.avatars}
    chosen = filmed.shots(capture, order.frames)
    console = printer()
    judged = []
    with Display(console) as display:
        display.stage("pictures")
        for one in filmed.judge(capture, chosen, entries, lpips=lpips):
            judged.append(one)
            display.step(len(judged), len(chosen))
    about = f"{len(chosen)} pictures of {capture.name}, inside the box around the mask, over white."
    write_bytes(order.output / "results.md", filmed_report.markdown(judged, list(entries), about).encode())
    write_bytes(order.output / "results.csv", filmed_report.as_csv(judged).encode())
    written = ["results.md", "results.csv"]
    for split in filmed.SPLITS:
        sheet = filmed_report.contact_sheet(judged, split)
        if sheet is not None:
            written.append(f"{split.replace(' ', '_')}.png")
            with replacing(order.output / written[-1]) as temporary:
                sheet.save(temporary)
    console.print(filmed_report.table(judged, list(entries)))
    console.print(f"{order.output}: {', '.join(written)}", highlight=False, soft_wrap=True, markup=False)
