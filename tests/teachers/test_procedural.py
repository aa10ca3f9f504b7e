"""The procedural character: what a teacher and a person who looks at it rely on; test_procedural_figure.py pins it."""

import numpy as np
import pytest
import trimesh
from scipy import ndimage
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from mua import rotation
from mua.arrays import Array
from mua.kernels.dq_skinning import blend_vertices
from mua.pose.clip import Clip
from mua.rig.character import Character
from mua.rig.texel_map import build_texel_map
from mua.teachers.procedural import procedural_character

TEMPLATE_LIMIT = 6000  # vertices that pass as a template without decimation
TEXELS = 256
TRUNK = ["Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"]
LIMBS = ["Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase"]


@pytest.fixture(scope="module")
def figure() -> Character:
    return procedural_character()


def _posed(figure: Character, clip: Clip, frame: int) -> Array:
    joints = figure.skeleton.skinning(clip.rotations[frame], clip.translations[frame])
    dual = blend_vertices(joints, figure.skin_indices, figure.skin_weights)
    return rotation.dual_transform(dual, figure.mesh.vertices)


def _components(faces: Array, count: int) -> Array:
    """Label [count] of the connected part that a corner belongs to."""
    a, b = faces.reshape(-1), faces[:, [1, 2, 0]].reshape(-1)
    return np.asarray(connected_components(coo_matrix((np.ones(len(a)), (a, b)), shape=(count, count)))[1])


def _capped(faces: Array, vertices: Array) -> tuple[Array, Array]:
    """The surface with a fan over every open edge loop."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    present = set(map(tuple, edges.tolist()))
    rim = np.array([edge for edge in present if edge[::-1] not in present]).reshape(-1, 2)
    loop = _components(np.c_[rim, rim[:, 0]], len(vertices))
    caps = []
    for label in np.unique(loop[rim[:, 0]]):
        mine = rim[loop[rim[:, 0]] == label]
        caps.append(np.c_[mine[:, ::-1], np.full(len(mine), len(vertices))])
        vertices = np.concatenate([vertices, vertices[mine[:, 0]].mean(axis=0, keepdims=True)])
    return np.concatenate([faces, *caps]), vertices


def test_is_small_enough_for_a_template(figure: Character) -> None:
    assert len(figure.mesh.vertices) <= TEMPLATE_LIMIT


def test_stands_on_the_ground_at_human_size_facing_z(figure: Character) -> None:
    low, high = figure.mesh.vertices.min(axis=0), figure.mesh.vertices.max(axis=0)
    assert low[1] == pytest.approx(0, abs=1e-3)
    assert 1.6 < high[1] < 1.8
    toes, heel = (figure.skeleton.names.index(name) for name in ("LeftToeBase", "LeftFoot"))
    _, places = figure.skeleton.world(figure.skeleton.bind_rotations, figure.skeleton.bind_translations)
    assert places[toes, 2] > places[heel, 2]
    assert places[toes, 0] > 0


def test_joints_have_the_usual_names(figure: Character) -> None:
    limbs = [side + limb for side in ("Left", "Right") for limb in LIMBS]
    assert sorted(figure.skeleton.names) == sorted(TRUNK + limbs)


def test_faces_are_wound_alike_and_no_edge_has_three(figure: Character) -> None:
    mesh = trimesh.Trimesh(figure.mesh.vertices, figure.mesh.faces, process=False)
    assert mesh.is_winding_consistent
    assert np.bincount(mesh.edges_unique_inverse).max() <= 2
    assert mesh.area_faces.min() > 0


def test_every_part_encloses_a_positive_volume(figure: Character) -> None:
    faces = figure.mesh.faces
    label = _components(faces, len(figure.mesh.vertices))[faces[:, 0]]
    assert len(np.unique(label)) == 14  # the dressed body with its head, hair, two legs, ten fingers
    for part in np.unique(label):
        closed, places = _capped(faces[label == part], figure.mesh.vertices)
        a, b, c = places[closed].swapaxes(0, 1)
        assert np.sum(a * np.cross(b, c)) / 6 > 0


def test_charts_fill_the_atlas_and_do_not_overlap(figure: Character) -> None:
    texels = build_texel_map(figure.mesh, TEXELS)
    assert texels.claimed_twice == 0
    assert len(texels.texels) > 0.55 * TEXELS**2


def test_two_texels_at_least_separate_charts(figure: Character) -> None:
    texels = build_texel_map(figure.mesh, TEXELS)
    chart = _components(figure.mesh.uv_faces, len(figure.mesh.uv))[figure.mesh.uv_faces[:, 0]]
    image = np.zeros((TEXELS, TEXELS), dtype=int)
    image.reshape(-1)[texels.texels] = chart[texels.triangles] + 1
    lowest = ndimage.minimum_filter(np.where(image == 0, image.max() + 1, image), size=3, mode="wrap")
    highest = ndimage.maximum_filter(image, size=3, mode="wrap")
    assert np.all((highest == 0) | (lowest == highest))  # no texel sees two charts within one texel of it


def test_same_seed_same_bytes_other_seed_other_folds(figure: Character) -> None:
    again, other = procedural_character(seed=0), procedural_character(seed=1)
    assert again.mesh.vertices.tobytes() == figure.mesh.vertices.tobytes()
    assert again.base_color.tobytes() == figure.base_color.tobytes()
    assert all(a.rotations.tobytes() == b.rotations.tobytes() for a, b in zip(again.clips, figure.clips, strict=True))
    assert other.mesh.vertices.shape == figure.mesh.vertices.shape
    assert np.abs(other.mesh.vertices - figure.mesh.vertices).max() > 0.01


def test_clips_are_finite_rotations_of_every_joint(figure: Character) -> None:
    assert {"walk", "turn", "reach", "dance"} <= {clip.name for clip in figure.clips}
    for clip in figure.clips:
        assert clip.rate == 30
        assert 2 <= len(clip) / clip.rate <= 4
        assert clip.rotations.shape == (len(clip), len(figure.skeleton.names), 4)
        assert np.isfinite(clip.translations).all()
        np.testing.assert_allclose(np.linalg.norm(clip.rotations, axis=-1), 1, atol=1e-12)
        assert np.all(np.sum(clip.rotations[1:] * clip.rotations[:-1], axis=-1) > 0)


@pytest.mark.parametrize("name", ["walk", "turn", "reach", "dance"])
def test_clips_loop(figure: Character, name: str) -> None:
    clip = next(clip for clip in figure.clips if clip.name == name)

    def angle(a: Array, b: Array) -> Array:
        return 2 * np.arccos(np.clip(np.abs(np.sum(a * b, axis=-1)), 0, 1))

    inside = angle(clip.rotations[1:], clip.rotations[:-1]).max()
    assert angle(clip.rotations[0], clip.rotations[-1]).max() <= inside
    step = np.linalg.norm(np.diff(clip.translations[:, 0], axis=0), axis=1).max()
    across = clip.translations[0, 0] - clip.translations[-1, 0]
    if name == "walk":  # it travels along +Z, a constant distance a loop
        across = across * [1, 1, 0]
    assert np.linalg.norm(across) <= step


@pytest.mark.parametrize("name", ["walk", "turn", "reach", "dance"])
def test_feet_stay_on_the_ground(figure: Character, name: str) -> None:
    clip = next(clip for clip in figure.clips if clip.name == name)
    lowest = [_posed(figure, clip, frame)[:, 1].min() for frame in range(0, len(clip), 7)]
    assert min(lowest) > -0.03
    assert max(lowest) < 0.03


def test_a_standing_foot_does_not_slide(figure: Character) -> None:
    walk = next(clip for clip in figure.clips if clip.name == "walk")
    _, places = figure.skeleton.world(walk.rotations, walk.translations)
    toes = places[:, figure.skeleton.names.index("LeftToeBase")]
    standing = toes[4:16]  # the left foot lies flat from a tenth to half of the first stride of 30 frames
    assert np.ptp(standing[:, [0, 2]], axis=0).max() < 0.01


@pytest.mark.parametrize("name", ["walk", "turn", "reach", "dance"])
def test_legs_stay_under_the_skirt(figure: Character, name: str) -> None:
    assert figure.looseness is not None
    height = figure.mesh.vertices[:, 1]
    skirt = np.flatnonzero((figure.looseness > 0.2) & (height < 1.0) & (np.abs(figure.mesh.vertices[:, 0]) < 0.46))
    legs = np.flatnonzero((figure.looseness == 0) & (height < 0.85) & (height > 0.45))
    clip = next(clip for clip in figure.clips if clip.name == name)
    for frame in range(0, len(clip), 9):
        posed = _posed(figure, clip, frame)
        normals = trimesh.Trimesh(posed, figure.mesh.faces, process=False).vertex_normals
        nearest = skirt[cKDTree(posed[skirt]).query(posed[legs])[1]]
        assert np.all(np.sum((posed[legs] - posed[nearest]) * normals[nearest], axis=1) < 0)
