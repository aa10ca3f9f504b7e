"""A trained teacher on disk: the rig, the settings and the weights, and nothing of the capture."""

import io
import json
import pickle
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import torch

from mua.errors import InputError
from mua.files.write import write_bytes
from mua.pose.encoding import PoseEncoding
from mua.recording.rig_file import read_rig, write_rig
from mua.rig.rig import Rig
from mua.teachers.trained.model import Subject, TeacherModel
from mua.teachers.trained.settings import LossWeights, TeacherSettings
from mua.training.schedule import Schedule

FILE, RIG, WEIGHTS = "teacher.json", "rig.npz", "weights.pt"
FORMAT, VERSION = "mua-teacher", 4


@dataclass(frozen=True)
class Description:
    """The content of teacher.json."""

    name: str  # of the person
    settings: TeacherSettings
    encoding: PoseEncoding
    roles: Mapping[str, str] = field(default_factory=dict)  # joint to body part, where the template's file says it


def save_teacher(folder: Path, model: TeacherModel, description: Description) -> None:
    """Write a teacher; teacher.json comes last, so that a folder that holds it is complete."""
    write_rig(folder / RIG, model.rig)
    content = io.BytesIO()  # an archive in a file would hold its temporary name, another one in each process
    torch.save({name: tensor.cpu() for name, tensor in model.state_dict().items()}, content)
    write_bytes(folder / WEIGHTS, content.getvalue())
    fields = {"format": FORMAT, "version": VERSION, **asdict(description)}
    write_bytes(folder / FILE, (json.dumps(fields, indent=1) + "\n").encode())


def load_teacher(folder: Path) -> tuple[TeacherModel, Description]:
    """Read a teacher; raises InputError where the folder holds none, or something in it is damaged."""
    description = _described(folder / FILE)
    rig: Rig = read_rig(folder / RIG)
    try:
        state = torch.load(folder / WEIGHTS, map_location="cpu", weights_only=True)
        model = TeacherModel(Subject(rig, state["surfels"], description.encoding), description.settings)
        model.load_state_dict(state)
    except (OSError, RuntimeError, EOFError, KeyError, TypeError, pickle.UnpicklingError) as error:
        raise InputError(f"{folder / WEIGHTS}: does not hold the weights that {FILE} describes") from error
    return model.requires_grad_(False).eval(), description


def teacher_bytes(folder: Path) -> Iterator[bytes]:
    """The files' bytes that a teacher's frames depend on, besides the motion."""
    for name in (FILE, WEIGHTS):
        yield (folder / name).read_bytes()


def _described(file: Path) -> Description:
    try:
        fields: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        if (fields["format"], fields["version"]) != (FORMAT, VERSION):
            raise InputError(
                f"{file}: format is {fields['format']!r}, version {fields['version']!r}; "
                f"expected {FORMAT!r}, {VERSION}; mua-teach trains it again"
            )
        own, encoding = dict(fields["settings"]), dict(fields["encoding"])
        own["weights"] = LossWeights(**own["weights"])
        for name in ("mean", "texture"):
            own[name] = Schedule(**own[name])
        for name in ("joints", "translated"):
            encoding[name] = tuple(encoding[name])
        return Description(str(fields["name"]), TeacherSettings(**own), PoseEncoding(**encoding), dict(fields["roles"]))
    except FileNotFoundError as error:
        raise InputError(f"{file.parent}: holds no {FILE}; expected the folder that mua-teach wrote") from error
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{file}: is damaged: {error}") from error
