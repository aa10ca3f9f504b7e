"""The input of the texture networks from the posed template; before training they show the textured mesh."""

import numpy as np
import pytest
import torch
from small_teachers import motion, subject, teacher

from mua.splatting.posing import rotate
from mua.teachers.trained.texels import SurfaceTextures, TexelNets, neighbours, normals
from mua.teachers.trained.unet import UNet
from mua.texture.surfels import vertex_normals

BOUND = 40 * float(np.finfo(np.float32).eps)  # some ten operations on lengths of up to 2 metres, twice


def posed() -> torch.Tensor:
    """The window of a frame [3, V, 3] in the world."""
    window = motion()[4]
    return teacher().template(window.descriptors, window.joints).posed


def nets() -> TexelNets:
    """Networks with random last layers."""
    torch.manual_seed(3)
    made = TexelNets(subject().rig, window=3, channels=4, levels=3, code=2, size=1.0)
    for net in (made.geometry, made.appearance):
        torch.nn.init.normal_(net.last.weight)
    return made.requires_grad_(False)


def test_an_untrained_teacher_draws_the_textured_mesh() -> None:
    frame = teacher()(motion()[2])
    assert torch.equal(frame.texture, subject().surfels)
    np.testing.assert_array_equal(frame.canonical.numpy(), subject().rig.mesh.vertices.astype(np.float32))


def test_networks_speak_in_what_a_pose_changes_of_a_channel() -> None:
    """Offsets by centimetres of a person, opacity by half a logit."""
    sizes = {"window": 3, "channels": 4, "levels": 3, "code": 2}
    person, giant = (TexelNets(subject().rig, **sizes, size=size).units for size in (1.0, 4.0))
    wanted = [0.01] * 3 + [0.05] * 4 + [0.1] * 3 + [0.5] + [0.2] * 3 + [0.1] * 9
    torch.testing.assert_close(person, torch.tensor(wanted))
    torch.testing.assert_close(giant / person, torch.tensor([4.0] * 3 + [1.0] * 20))


def test_textures_hold_place_and_normal_of_each_texel() -> None:
    rig, vertices = subject().rig, posed()
    image = SurfaceTextures(rig)(vertices)
    assert image.shape == (1, 18, rig.texels.size, rig.texels.size)
    corners = rig.mesh.faces[rig.texels.triangles]
    for age, own in enumerate(vertices.double().numpy()):
        for first, values in ((0, own), (3, vertex_normals(own, rig.mesh.faces))):
            wanted = np.einsum("nc,ncd->nd", rig.texels.barycentrics, values[corners])
            channels = slice(6 * age + first, 6 * age + first + 3)
            found = image[0, channels].flatten(1)[:, torch.from_numpy(rig.texels.texels).long()].T
            np.testing.assert_allclose(found.numpy(), wanted, rtol=0, atol=BOUND)
    empty = np.setdiff1d(np.arange(rig.texels.size**2), rig.texels.texels)
    assert not image.flatten(2)[..., torch.from_numpy(empty)].any()


def test_normals_of_a_vertex_whose_faces_cancel_are_zero() -> None:
    vertices = torch.tensor([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    assert not normals(vertices, torch.tensor([[0, 1, 2], [0, 2, 1]])).any()


def test_where_a_person_stands_changes_nothing() -> None:
    made, vertices, code = nets(), posed(), torch.zeros(2)
    root, back, away = torch.tensor([0.1, 0.9, 0]), torch.tensor([1.0, 0, 0, 0]), torch.tensor([3.0, 0, -2])
    here, there = made(vertices, root, back, code), made(vertices + away, root + away, back, code)
    torch.testing.assert_close(there, here, rtol=0, atol=1e-3 * float(here.abs().max()))


def test_where_a_person_faces_changes_the_light_alone() -> None:
    made, vertices, code, root = nets(), posed(), torch.zeros(2), torch.zeros(3)
    none, half = torch.tensor([1.0, 0, 0, 0]), torch.tensor([0.5**0.5, 0, 0.5**0.5, 0])
    turned = rotate(half.expand(*vertices.shape[:2], 4), vertices)
    here = made(vertices, root, none, code)
    there = made(turned, root, half * torch.tensor([1, -1, -1, -1]), code)
    spread = float(here.abs().max())
    torch.testing.assert_close(there[:, :11], here[:, :11], rtol=0, atol=1e-3 * spread)
    assert float((there[:, 11:] - here[:, 11:]).abs().max()) > 0.01 * spread


def test_a_look_changes_the_appearance_alone() -> None:
    made, vertices, root, none = nets(), posed(), torch.zeros(3), torch.tensor([1.0, 0, 0, 0])
    one, other = (made(vertices, root, none, torch.full((2,), look)) for look in (0.0, 1.0))
    assert torch.equal(one[:, :11], other[:, :11])
    assert not torch.equal(one[:, 11:], other[:, 11:])


def test_levels_are_twice_as_wide_up_to_eight_times() -> None:
    widths = [block[0].out_channels for block in UNet(3, 2, channels=2, levels=6).down]  # type: ignore[index]
    assert widths == [2, 4, 8, 16, 16, 16]


@pytest.mark.parametrize("levels", [1, 2, 4])
def test_a_unet_begins_at_zero_and_sees_far(levels: int) -> None:
    net = UNet(3, 2, channels=4, levels=levels)
    image = torch.randn(1, 3, 32, 32, requires_grad=True)
    assert net(image).shape == (1, 2, 32, 32)
    assert not net(image).any()
    torch.nn.init.ones_(net.last.weight)
    (gradient,) = torch.autograd.grad(net(image)[0, :, 16, 16].sum(), image)
    reach = int(torch.nonzero(gradient[0].abs().sum(dim=0))[:, 0].sub(16).abs().max())
    assert reach >= 2**levels


def test_texels_are_neighbours_where_they_touch_in_the_texture() -> None:
    """Of a texture of 3 x 3, the corners above and the row in the middle."""
    pairs = neighbours(torch.tensor([0, 2, 3, 4, 5]), 3)
    assert sorted(map(tuple, pairs.T.tolist())) == [(0, 2), (1, 4), (2, 3), (3, 4)]
