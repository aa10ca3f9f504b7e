"""From a recording on disk to a student: its frames, its joints, and a resumed run."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import torch
from synthetic_avatar import SIZE, synthetic_clip, synthetic_rig
from synthetic_student import SETTINGS, quick, same

from mua.asset.read import read
from mua.asset.write import write
from mua.avatar.decode import decode_clip_frame
from mua.baking.assemble import assemble
from mua.channels import ATTRIBUTES, CHANNELS
from mua.errors import InputError
from mua.pose import components
from mua.pose.clip import RANGE_OF_MOTION, REST
from mua.pose.descriptor import describe
from mua.pose.skeleton import Pose
from mua.recording import Recording, TeacherWriter
from mua.rig.skinning import moving_joints
from mua.student import distil as student_of
from mua.student.distil import distil, prepare
from mua.student.model import Student
from mua.student.settings import Settings

CPU = torch.device("cpu")
BRANCH = ("bases", "coefficients", "fine-tuning")
ALL = {"coarse mesh", *(f"{name} {stage}" for name in ("geometry", "appearance") for stage in BRANCH)}  # stages
RELATIVE = 1e-5  # share of the largest value: a float32 file against the torch student


class Heard:
    """A listener that records its calls."""

    def __init__(self) -> None:
        self.stages: list[str] = []
        self.steps: list[tuple[int, int]] = []

    def stage(self, name: str) -> None:
        self.stages.append(name)

    def step(self, done: int, total: int, *, detail: str = "") -> None:
        self.steps.append((done, total))


def recording(
    directory: Path,
    *,
    training: int = 2,
    held: int = 0,
    still: int | None = None,
    names: Sequence[str] = (),
    opacity: float = 0.0,
) -> Recording:
    """`training` clips and a held-out one whose values are far off; every second frame is recorded.

    `held` is the seed of the held-out clip, which alone moves the joint `still`, in its place too. The first clips
    may have `names`, all textures another `opacity`.
    """
    rig, rng = synthetic_rig(), np.random.default_rng(0)
    with TeacherWriter(directory, rig, rate=24.0) as writer:
        for number in range(training + 1):
            held_out = number == training
            rng = np.random.default_rng([held, 1]) if held_out else rng
            clip = synthetic_clip(rig.skeleton, rng, frames=9)
            if still is not None and not held_out:
                clip.rotations[:, still] = rig.skeleton.bind_rotations[still]
                clip.translations[:, still] = rig.skeleton.bind_translations[still]
            writer.start_clip(names[number] if number < len(names) else f"clip {number}", held_out=held_out)
            for frame in range(len(clip)):
                pose = Pose(clip.rotations[frame], clip.translations[frame])
                mesh = (rig.mesh.vertices + 0.01 * rng.normal(size=3)).astype(np.float32)
                texture = rng.normal(0, 0.1, (len(rig.texels.texels), CHANNELS))
                texture[:, 3] += 1
                texture[:, ATTRIBUTES["scale"]] -= 4
                texture[:, ATTRIBUTES["opacity"]] += opacity
                if held_out:
                    texture[:, ATTRIBUTES["opacity"]] += 50
                    texture[:, ATTRIBUTES["SH"]] += 4
                writer.add(pose, *((mesh, texture.astype(np.float32)) if frame % 2 else ()))
    return Recording(directory)


def settings() -> Settings:
    return replace(quick(SETTINGS), texels=SIZE)


def distilled(source: Recording, directory: Path, heard: Heard) -> Student:
    return distil(source, settings(), device=CPU, directory=directory, report=heard)


def test_distils_the_training_frames_alone(tmp_path: Path) -> None:
    source = recording(tmp_path / "recording")
    student = distilled(source, tmp_path / "student", Heard())
    assert source.count() == 2 * 4
    mean = (student.mean_lowpass() + student.static).T
    assert np.abs(mean.numpy() - source.mean_texture()).max() < 1e-3  # half precision of the subbands' mean


def test_held_out_clips_change_nothing_in_a_student(tmp_path: Path) -> None:
    """Not what it reads of a pose, nor its normalisation, means, bases or weights."""
    students = []
    for held in (1, 2):
        source = recording(tmp_path / f"recording {held}", held=held, still=2)
        students.append(distilled(source, tmp_path / f"student {held}", Heard()))
    first, second = students
    assert first.encoding == second.encoding
    assert first.encoding.joints == (1,)
    assert first.encoding.translated == ()
    assert same(first, second)


def test_the_pose_in_which_a_file_stands_counts_more_than_other_frames_that_are_not_the_users(tmp_path: Path) -> None:
    names = ("own", f"{RANGE_OF_MOTION}walk", f"{RANGE_OF_MOTION}{REST}")
    source = recording(tmp_path / "recording", training=3, names=names)
    _, samples = prepare(source, settings())
    assert samples.weights is not None
    own, others, standing = samples.weights.reshape(3, -1)
    assert (own == 1).all()
    assert 0 < others.max() < standing.min() < 1


def test_a_second_run_repeats_nothing_and_gives_the_same_student(tmp_path: Path) -> None:
    source = recording(tmp_path / "recording")
    heard = Heard()
    first = distilled(source, tmp_path / "student", heard)
    assert set(heard.stages) == ALL
    again = Heard()
    second = distilled(source, tmp_path / "student", again)
    assert again.steps == []
    assert same(first, second)


def test_a_recording_that_grew_is_distilled_anew(tmp_path: Path) -> None:
    distilled(recording(tmp_path / "short"), tmp_path / "student", Heard())
    heard = Heard()
    distilled(recording(tmp_path / "long", training=3), tmp_path / "student", heard)
    assert set(heard.stages) == ALL


def test_a_recording_of_the_same_motion_with_other_textures_is_distilled_anew(tmp_path: Path) -> None:
    distilled(recording(tmp_path / "one"), tmp_path / "student", Heard())
    heard = Heard()
    found = distilled(recording(tmp_path / "other", opacity=1.0), tmp_path / "student", heard)
    assert set(heard.stages) == ALL
    assert float(found.mean_lowpass()[10].mean()) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize(("module", "name", "value"), [(components, "FORGONE", 0.5), (student_of, "REST_WEIGHT", 0.6)])
def test_what_was_distilled_by_other_rules_is_distilled_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: ModuleType, name: str, value: float
) -> None:
    source = recording(tmp_path / "recording", training=2, names=("own", f"{RANGE_OF_MOTION}{REST}"))
    distilled(source, tmp_path / "student", Heard())
    monkeypatch.setattr(module, name, value)
    heard = Heard()
    found = distilled(source, tmp_path / "student", heard)
    assert set(heard.stages) == ALL
    assert same(found, distilled(source, tmp_path / "fresh", Heard()))


def test_joints_move_the_mesh_themselves_or_through_a_descendant() -> None:
    rig = synthetic_rig()
    first = np.zeros_like(rig.skin_weights)
    first[:, 0] = 1
    for joint, expected in ((0, [True, False, False]), (1, [True, True, False]), (2, [True, True, True])):
        indices = np.full_like(rig.skin_indices, 2)  # also where nothing weighs on it
        indices[:, 0] = joint
        alone = replace(rig, skin_indices=indices, skin_weights=first)
        assert moving_joints(alone).tolist() == expected


def test_decode_is_the_student_where_joints_move_in_their_parents(tmp_path: Path) -> None:
    """From the pose on: descriptor, MLPs and textures, with a joint whose translation is in the descriptor."""
    source = recording(tmp_path / "recording")
    student = distilled(source, tmp_path / "student", Heard())
    assert student.encoding.translated == (2,)
    avatar = assemble(student, source.rig, name="a", encoding=student.encoding, clips=source.clips, notes="")
    write(tmp_path / "a.muaavatar", avatar, storage="f32")
    avatar = read(tmp_path / "a.muaavatar")
    clip = avatar.clips[1]
    described = describe(source.rig.skeleton, student.encoding, clip.rotations, clip.translations)[5:6]
    seen = torch.from_numpy(described).float()
    mesh, texture = student.mesh(seen)[0].numpy(), student.texture(student.predict(seen))[0].numpy()
    found = decode_clip_frame(avatar, clip, frame=5)
    assert np.abs(found.canonical - mesh).max() < RELATIVE * np.abs(mesh).max()
    assert np.abs(found.texture - texture).max() < RELATIVE * np.abs(texture).max()


def test_rejects_a_recording_of_another_texture_size(tmp_path: Path) -> None:
    source = recording(tmp_path / "recording")
    with pytest.raises(InputError, match="has 32 texels along a side, expected 384"):
        distil(source, replace(settings(), texels=384), device=CPU, directory=tmp_path, report=Heard())


def test_rejects_a_recording_without_training_frames(tmp_path: Path) -> None:
    source = recording(tmp_path / "recording", training=0)
    with pytest.raises(InputError, match="holds no training frame"):
        distilled(source, tmp_path / "student", Heard())
