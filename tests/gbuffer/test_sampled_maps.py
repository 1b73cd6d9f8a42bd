"""Normal maps as pixels sample them, without an OpenGL driver."""

from dataclasses import replace

import numpy as np
import pytest
from halves import CORNERS, RIM, WAYS, dome, file_tangents, halves, picture, uv_of
from written import Document, png_bytes

from normalbench.gbuffer.scenes.files.read import read_mesh_file, seen
from normalbench.gbuffer.scenes.metal_rough import Map
from normalbench.gbuffer.scenes.sampled import Pyramid

SIDE = 64
SQUARE = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]


def square(data: bytes, uv, away: float = 3.0, info=None, **more) -> Document:
    """Return a 2 x 2 square that faces a camera, entirely in the image; `more` are vertex attributes."""
    document = Document()
    document.texture(data, wrapS=33071, wrapT=33071)
    document.material(normalTexture={"index": 0, **(info or {})})
    corners = np.concatenate([CORNERS, np.zeros((4, 1))], axis=1)
    more = {"TEXCOORD_0": uv} | more
    document.node(mesh=document.mesh(corners, [(0, 0, 1)] * 4, [(0, 1, 2), (0, 2, 3)], material=0, **more))
    document.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}]
    document.node(camera=0, translation=[0, 0, away])
    return document


def as_seen(document: Document, tmp_path):
    """Return the normals of covered pixels inside the square, and their positions on it."""
    shown = seen(read_mesh_file(document.write(tmp_path / "a.glb")), (SIDE, SIDE))
    inner = shown.covered & (abs(shown.positions[..., :2]).max(axis=-1) < 0.97)
    assert inner.sum() > 100
    return shown.normals[inner], shown.positions[inner]


@pytest.mark.parametrize("way", range(len(WAYS)))
@pytest.mark.parametrize("how", ["computed", "authored", "transformed"])
def test_dome_in_a_map_is_a_dome_in_every_orientation(tmp_path, how, way):
    """The image is turned or mirrored, with tangents from the file or computed from the uv coordinates: the dome
    bulges towards the eye, and its left side faces left."""
    turn = WAYS[way]
    more, info = {}, None
    if how == "authored":
        more = {"TANGENT": file_tangents(turn)}
    if how == "transformed":
        # Back and forth: the picture lies upright, and turned by 90 degrees about its middle.
        info = {"extensions": {"KHR_texture_transform": {"rotation": np.pi / 2, "offset": [0, 1]}}}
    document = square(picture(dome), uv_of(turn), info=info, **more)
    normals, positions = as_seen(document, tmp_path)
    assert abs(normals[:, :2] - RIM * positions[:, :2]).max() < 2e-3, f"{how}, {turn.tolist()}"


@pytest.mark.parametrize("way", range(len(WAYS)))
@pytest.mark.parametrize("authored", [False, True])
def test_modelled_and_mapped_normals_are_the_same(tmp_path, way, authored):
    """The comparison is pixel by pixel: the distance between the squares is a whole number of pixels here."""
    shown = seen(read_mesh_file(halves(WAYS[way], authored).write(tmp_path / "a.glb")), (256, 128))
    columns = np.nonzero(shown.covered.any(axis=0))[0]
    gap = np.flatnonzero(np.diff(columns) > 1)
    left, right = np.split(columns, gap + 1)
    assert len(left) == len(right) > 40
    normals = [shown.normals[:, half][shown.covered[:, half].all(axis=1)][2:-2, 2:-2] for half in (left, right)]
    assert abs(normals[0] - normals[1]).max() < 0.02, f"{WAYS[way].tolist()}: {abs(normals[0] - normals[1]).max():.3f}"


def test_normal_map_scale_multiplies_the_slopes(tmp_path):
    document = square(picture(dome), uv_of(WAYS[0]), info={"scale": 0.5})
    normals, positions = as_seen(document, tmp_path)
    xy = RIM * positions[:, :2]
    z = np.sqrt(1 - np.sum(xy * xy, axis=1, keepdims=True))
    expected = np.concatenate([0.5 * xy, z], axis=1)
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    assert abs(normals - expected).max() < 2e-3


def test_slopes_finer_than_a_pixel_are_averaged(tmp_path):
    """Stripes one texel wide, a hundred per pixel, average to flat; the constant slope of the map remains."""
    stripes = picture(lambda right, up: (0.5 * np.sign(np.sin(right * 64 * np.pi)), np.full_like(up, 0.25)))
    document = square(stripes, uv_of(WAYS[0]) * 40)
    document.json["samplers"][0] = {}
    normals, _ = as_seen(document, tmp_path)
    n = np.array([0, 0.25, np.sqrt(1 - 0.25 - 0.0625)])
    assert abs(normals - n / np.linalg.norm(n)).max() < 0.02


def test_stripes_seen_at_a_slant_are_not_averaged():
    """The footprint is 16 texels by one, along the stripes; an isotropic filter would return their mean."""
    texels = np.zeros((64, 64, 4), np.uint8)
    texels[:, ::2] = 255
    pyramid = Pyramid(Map(texels))
    uv = np.array([(8.5 / 64, 0.5), (9.5 / 64, 0.5)])
    single, sixteen = np.array([(1 / 64, 0)] * 2), np.array([(0, 16 / 64)] * 2)
    for sides in ((single, sixteen), (sixteen, single)):
        assert np.allclose(pyramid.through(uv, *sides), [[1] * 3, [-1] * 3])


@pytest.mark.parametrize("shape", [(7, 5), (1, 9), (8, 3), (1, 1)])
def test_every_level_has_the_mean_of_the_map(shape):
    texels = np.random.default_rng(0).integers(0, 256, (*shape, 4), np.uint8)
    levels = Pyramid(Map(texels)).levels
    assert levels[-1].shape == (1, 1, 3)
    mean = levels[0].mean(axis=(0, 1), dtype=np.float64)
    assert all(np.allclose(level.mean(axis=(0, 1)), mean, atol=1e-6) for level in levels)


@pytest.mark.parametrize("wrap, mode", [("repeat", "wrap"), ("mirror", "symmetric"), ("clamp", "edge")])
def test_texels_outside_an_image_follow_its_wrap_mode(wrap, mode):
    """Texels up to twice the image's size beyond its edges are compared with NumPy's padding modes."""
    texels = np.random.default_rng(0).integers(0, 256, (3, 5, 4), np.uint8)
    padded = np.pad(texels, ((6, 6), (10, 10), (0, 0)), mode)[..., :3] / 255 * 2 - 1
    row, column = np.indices(padded.shape[:2]).reshape(2, -1)
    uv = np.stack([(column - 10 + 0.5) / 5, (row - 6 + 0.5) / 3], axis=1)
    still = np.zeros_like(uv)
    normals = Pyramid(Map(texels, wrap=(wrap, wrap))).through(uv, still, still)
    assert abs(normals - padded[row, column]).max() < 1e-6


def test_pixels_record_their_triangle(tmp_path):
    """Pixels above the square's diagonal belong to triangle 1, and coverage does not depend on the normal map."""
    file = read_mesh_file(square(picture(lambda x, y: (0 * x, 0 * y)), uv_of(WAYS[0])).write(tmp_path / "a.glb"))
    shown = seen(file, (SIDE, SIDE))
    above = shown.positions[..., 1] > shown.positions[..., 0]
    assert np.array_equal(shown.triangle[shown.covered & above] == 1, np.ones((shown.covered & above).sum(), bool))
    assert not shown.triangle[shown.covered & ~above].all()
    plain = replace(file, materials=tuple(replace(m, normal_map=None) for m in file.materials))
    assert np.array_equal(seen(plain, (SIDE, SIDE)).covered, shown.covered)


@pytest.mark.parametrize("cutoff, share", [(0.0, 1.0), (0.5, 0.75), (1.5, 0.0)])
def test_masked_texels_show_the_surface_behind(tmp_path, cutoff, share):
    """A square with a transparent upper left quarter is in front of a square that fills the view and faces up."""
    texels = np.full((64, 64, 4), 255, np.uint8)
    texels[:32, :32, 3] = 0
    document = square(picture(dome), uv_of(WAYS[0]))
    pbr = {"baseColorTexture": {"index": document.texture(png_bytes(texels), wrapS=33071, wrapT=33071)}}
    document.json["materials"][0] = {"alphaMode": "MASK", "alphaCutoff": cutoff, "pbrMetallicRoughness": pbr}
    behind = document.mesh(np.array(SQUARE) * 40, [(0, 1, 0)] * 4, [(0, 1, 2), (0, 2, 3)])
    document.node(mesh=behind, translation=[0, 0, -1])
    shown = seen(read_mesh_file(document.write(tmp_path / "a.glb")), (SIDE, SIDE))
    front = shown.normals[..., 2] > 0.5
    assert shown.covered.all()
    whole = (2 / (2 * 3 * np.tan(0.35)) * SIDE) ** 2
    assert front.sum() == pytest.approx(share * whole, rel=0.05)
    quarter = front[: SIDE // 2, : SIDE // 2]
    assert quarter.any() == (cutoff == 0)


def test_error_of_an_8_bit_map_matches_the_16_bit_map(tmp_path):
    """The error is estimated without the 16-bit map, to within 20%. Half of the image has no map and is exact."""
    fine, coarse = (
        seen(read_mesh_file(halves(WAYS[0], kind=kind).write(tmp_path / f"{kind.__name__}.glb")), (160, 120))
        for kind in (np.uint16, np.uint8)
    )
    apart = (fine.normals.astype(np.float64) - coarse.normals)[fine.covered]
    right = float(np.degrees(np.linalg.norm(apart, axis=1)).mean())
    assert fine.map_error_deg is None and 0.02 < right < 0.12, right
    assert coarse.map_error_deg == pytest.approx(right, rel=0.2), right
