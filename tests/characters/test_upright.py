"""A person who lies in the bind pose is turned upright; nobody else is turned."""

from dataclasses import replace

import numpy as np
import pytest
from people import person
from scenes import GREY, HERE, at, part
from scipy.spatial.transform import Rotation

from mua.atlas.character_surfaces import Surfaces
from mua.characters.animation import bare_animation
from mua.characters.assemble import assemble
from mua.pose.joint_names import roles
from mua.scene import Scene, Skin


def whole(
    turn: Rotation, *, sitting: float = 0.0, bent: float = 0.0, rest: Rotation | None = None, stoops: float = 0.0
) -> Scene:
    """A person turned as a whole, the thighs lifted by `sitting` degrees, forearms and shins bent to the front by
    `bent`; at rest turned as `rest` says and the trunk bent to the front by `stoops`.
    """
    skeleton = person()
    _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    legs = [name.endswith(("Leg", "Foot", "ToeBase")) for name in skeleton.names]
    bow = Rotation.from_euler("x", stoops, degrees=True)
    for side, inwards in (("Left", -bent), ("Right", bent)):
        for name, axis, degrees in (("UpLeg", "x", -sitting), ("Leg", "x", -bent), ("ForeArm", "y", inwards)):
            hinge = skeleton.names.index(f"{side}{name}")
            for joint in range(len(places)):
                if hinge in skeleton.ancestors(joint):
                    lift = Rotation.from_euler(axis, degrees, degrees=True)
                    places[joint] = places[hinge] + lift.apply(places[joint] - places[hinge])
    bowed = np.where(np.array(legs)[:, None], places, places[0] + bow.apply(places - places[0]))
    bound, rests = (
        np.stack([at(x, y, z, t) for x, y, z in t.apply(posed)]) for t, posed in ((turn, places), (rest or turn, bowed))
    )
    count = len(places)
    skin = Skin(np.arange(count), np.linalg.inv(bound))
    joints = np.stack([np.arange(count), np.roll(np.arange(count), 1)], axis=1)
    corners = turn.apply(np.concatenate([places, places + 0.02, places - [0.02, 0, 0]]))
    faces = np.stack([np.arange(count), np.arange(count) + count, np.arange(count) + 2 * count], axis=1)
    mesh = replace(
        part(count=3 * count),
        positions=corners,
        joints=np.tile(joints, (3, 1)),
        weights=np.tile([0.75, 0.25], (3 * count, 1)),
        faces=faces,
        uv_faces=faces,
    )
    return Scene("body", skeleton.names, skeleton.parents, rests, (skin,), (mesh,), (GREY,), (), ())


def places_of(surfaces: Surfaces) -> dict[str, np.ndarray]:
    skeleton = surfaces.skeleton
    _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    return {role: places[joints[0]] for role, joints in roles(skeleton).items()}


STANDS = places_of(assemble(whole(Rotation.identity()), HERE))


@pytest.mark.parametrize(
    ("axis", "degrees", "stoops"),
    [
        *(("x", 90, 0), ("x", -90, 0), ("z", 90, 0), ("z", -90, 0), ("x", 90, 80), ("z", 90, 80), ("z", -90, 80)),
        *(("x", 180, 0), ("z", 180, 0), ("z", 180, 80)),
    ],
)
def test_a_person_who_lies_is_made_to_stand(axis: str, degrees: float, stoops: float) -> None:
    surfaces = assemble(whole(Rotation.from_euler(axis, degrees, degrees=True), stoops=stoops), HERE)
    assert any("it is turned upright" in note for note in surfaces.notes)
    for role, place in places_of(surfaces).items():
        np.testing.assert_allclose(place, STANDS[role], atol=1e-9)


@pytest.mark.parametrize(
    "scene",
    [
        whole(Rotation.identity()),
        whole(Rotation.identity(), sitting=80),
        whole(Rotation.from_euler("x", 90, degrees=True), sitting=80),  # on four legs
        whole(Rotation.from_euler("x", 90, degrees=True), bent=90),  # on short ones
        whole(Rotation.from_euler("x", 45, degrees=True)),
        whole(Rotation.from_euler("x", 55, degrees=True)),
        whole(Rotation.from_euler("x", 90, degrees=True), rest=Rotation.identity()),
        whole(Rotation.from_euler("x", 90, degrees=True), rest=Rotation.identity(), stoops=80),
        whole(Rotation.from_euler("x", -90, degrees=True), rest=Rotation.identity(), stoops=80),
        whole(Rotation.from_euler("x", -90, degrees=True), stoops=80),  # sits up on the floor
    ],
)
def test_who_stands_sits_leans_or_goes_on_four_legs_is_not_turned(scene: Scene) -> None:
    assert not any("turned upright" in note for note in assemble(scene, HERE).notes)


def test_who_lies_in_motion_without_a_mesh_keeps_lying() -> None:
    lying = whole(Rotation.from_euler("x", -90, degrees=True))
    assert bare_animation(replace(lying, parts=()), HERE).notes == ()


def test_who_stands_kilometres_from_the_origin_is_moved_there() -> None:
    far = whole(Rotation.identity())
    surfaces = assemble(replace(far, rest=at(20_000.0, 500.0, -15_000.0) @ far.rest), HERE)
    assert "The character stands 25 km from the origin of its file; it is moved there." in surfaces.notes
    assert abs(surfaces.vertices).max() < 3
    assert surfaces.vertices[:, 1].min() == pytest.approx(0, abs=1e-9)
