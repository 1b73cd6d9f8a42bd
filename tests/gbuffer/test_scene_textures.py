"""Images in glTF files: texels, their placement and the tangents that normal maps need."""

import base64
import io
import struct

import numpy as np
import pytest
from PIL import Image
from written import POSITIONS, TRIANGLE, Document, chunk, png_bytes

from normalbench.bench.run.measuring import companions
from normalbench.gbuffer.scenes.files import gltf_materials, texels
from normalbench.gbuffer.scenes.files.read import read_mesh_file
from normalbench.gbuffer.scenes.files.source import SceneFileError
from normalbench.gbuffer.scenes.mesh import Mesh, laid_by, tangents

UV = [(0, 0), (1, 0), (0, 1)]


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


QUAD = [(0, 1, 2), (0, 2, 3)]


# Its uv as a picture lies upright on it: v grows downwards.
UPRIGHT = [(0, 1), (1, 1), (1, 0), (0, 0)]


def noise(channels: int, kind=np.uint8, height: int = 3, width: int = 5) -> np.ndarray:
    return np.random.default_rng(channels).integers(0, np.iinfo(kind).max, (height, width, channels), kind)


def saved(pixels: np.ndarray, format: str) -> bytes:
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, format, **({"lossless": True} if format == "WEBP" else {}))
    return file.getvalue()


def with_texture(document: Document, key: str = "normalTexture", info=None, mesh=None, **more) -> Document:
    """Add a triangle whose material has one texture; `more` are the material's other properties."""
    holder = {key: {"index": 0} | (info or {})}
    is_pbr = key in ("baseColorTexture", "metallicRoughnessTexture")
    document.material(**({"pbrMetallicRoughness": holder} if is_pbr else holder), **more)
    document.node(mesh=document.mesh(TRIANGLE, material=0, **({"TEXCOORD_0": UV} if mesh is None else mesh)))
    return document


def read(document: Document, tmp_path):
    return read_mesh_file(document.write(tmp_path / "a.glb"))


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_png_is_read_as_four_channels(kind, channels):
    """Grey fills all three colours, missing alpha is full, and row 0 is the top: v = 0."""
    pixels = noise(channels, kind)
    image = texels.texels(png_bytes(pixels))
    assert image.dtype == kind and image.shape == (3, 5, 4)
    assert np.array_equal(image[..., :3], np.broadcast_to(pixels[..., : 3 if channels > 2 else 1], (3, 5, 3)))
    assert np.array_equal(image[..., 3], pixels[..., -1] if channels in (2, 4) else np.full((3, 5), np.iinfo(kind).max))


def test_jpeg_and_webp_pixels_are_read_correctly():
    ramp = np.stack([np.tile(np.arange(0, 256, 4, dtype=np.uint8), (64, 1))] * 3, axis=-1)
    assert np.array_equal(texels.texels(saved(ramp, "WEBP"))[..., :3], ramp)
    # What JPEG's transform leaves of a ramp in grey.
    assert abs(texels.texels(saved(ramp, "JPEG")).astype(int)[..., :3] - ramp).max() <= 4


def test_16_bit_image_with_a_damaged_profile_is_read_silently(capfd):
    """Colour profiles are ignored, but libpng would print a warning about this one on standard error."""
    data = png_bytes(noise(3, np.uint16))
    profile = chunk(b"iCCP", b"a profile\0\0that is none")
    image = texels.texels(data[:33] + profile + data[33:])
    assert np.array_equal(image[..., :3], noise(3, np.uint16)) and capfd.readouterr() == ("", "")


@pytest.mark.parametrize("how", ["in the file", "beside it", "as data"])
def test_the_five_maps_are_read_from_any_location(tmp_path, how):
    document = Document()
    keys = ("baseColorTexture", "metallicRoughnessTexture", "normalTexture", "occlusionTexture", "emissiveTexture")
    pictures = [noise(4) + number for number in range(5)]
    for number, pixels in enumerate(pictures):
        data = png_bytes(pixels)
        if how == "beside it":
            (tmp_path / f"{number} of 5.png").write_bytes(data)
        document.texture(
            data if how == "in the file" else f"{number}%20of%205.png" if how == "beside it" else uri(data)
        )
    maps = {key: {"index": number} for number, key in enumerate(keys)}
    maps["normalTexture"] |= {"scale": 0.5}
    maps["occlusionTexture"] |= {"strength": 0.25}
    pbr = {key: maps.pop(key) for key in keys[:2]}
    document.material(pbrMetallicRoughness=pbr, alphaMode="BLEND", emissiveFactor=[1, 1, 1], **maps)
    document.node(mesh=document.mesh(TRIANGLE, material=0, TEXCOORD_0=UV))
    material = read(document, tmp_path).materials[0]
    assert all(np.array_equal(m.texels, pixels) for m, pixels in zip(material.maps, pictures, strict=True))
    assert [m.is_srgb for m in material.maps] == [True, False, False, False, True]
    assert (material.normal_scale, material.occlusion_strength) == (0.5, 0.25)


def uri(data: bytes) -> str:
    return "data:image/png;base64," + base64.b64encode(data).decode()


def test_map_placement_uses_its_sampler_uv_set_and_transform(tmp_path):
    """The image is turned by 90°, repeated twice along u and moved. A positive rotation takes (1, 0) to (0, -1), up
    in the image."""
    transform = {"offset": [0.25, 0.5], "rotation": np.pi / 2, "scale": [2, 1], "texCoord": 1}
    document = Document()
    document.texture(png_bytes(noise(3)), wrapS=33071, wrapT=33648)
    info = {"texCoord": 0, "extensions": {"KHR_texture_transform": transform}}
    with_texture(document, "occlusionTexture", info, {"TEXCOORD_0": UV, "TEXCOORD_1": UPRIGHT[:3]})
    file = read(document, tmp_path)
    lying = file.materials[0].occlusion_map
    assert (lying.wrap, lying.uv_set) == (("clamp", "mirror"), 1)
    corners = np.array([(0, 0, 1), (1, 0, 1), (0, 1, 1)]) @ lying.placed.T
    assert np.allclose(corners, [(0.25, 0.5), (0.25, 0.5 - 2), (0.25 + 1, 0.5)], atol=1e-15)
    assert np.array_equal(file.pieces[0].mesh.second_uv, UPRIGHT[:3])


def test_only_blended_and_masked_materials_keep_alpha(tmp_path):
    """An opaque material's image loses its alpha; a blended material is below 1 if its image has transparency."""
    clear, full = noise(4), noise(3)
    alphas = []
    for pixels, more in (
        (clear, {}),
        (clear, {"alphaMode": "MASK"}),
        (clear, {"alphaMode": "BLEND"}),
        (full, {"alphaMode": "BLEND"}),
    ):
        document = Document()
        document.texture(png_bytes(pixels))
        material = read(with_texture(document, "baseColorTexture", **more), tmp_path).materials[0]
        alphas.append((material.alpha, material.cutoff, int(material.base_map.texels[..., 3].min())))
    least = int(clear[..., 3].min())
    assert alphas == [(1, 0, 255), (1, 0.5, least), (1 - 2.0**-24, 0, least), (1, 0, 255)]


def test_16_bit_colours_are_linear(tmp_path):
    """By IEC 61966-2-1, an encoded 0.5 is 0.21404 in linear light, and 0.02 is 0.02 / 12.92."""
    document = Document()
    document.texture(png_bytes(np.round(np.array([[[0.5, 0.02, 1.0]]]) * 65535).astype(np.uint16)))
    lying = read(with_texture(document, "baseColorTexture"), tmp_path).materials[0].base_map
    assert not lying.is_srgb
    assert lying.texels[0, 0, :3] / 65535 == pytest.approx([0.21404, 0.02 / 12.92, 1.0], abs=1.5e-5)


def test_each_unsupported_feature_is_noted_once(tmp_path):
    document = Document()
    document.json["textures"] = [{"extensions": {"KHR_texture_basisu": {"source": 0}}}, {}]
    document.json |= {"extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_ior", "KHR_texture_basisu"]}
    for number in (0, 0, 1):
        document.material(normalTexture={"index": number})
    document.node(mesh=document.mesh(TRIANGLE, [(0, 0, 1)] * 3, material=0, COLOR_0=np.ones((3, 4)), TEXCOORD_0=UV))
    file = read(document, tmp_path)
    assert all(material.maps == (None,) * 5 for material in file.materials)
    assert file.notes == (
        "vertex colours are ignored",
        "KHR_materials_clearcoat is ignored",
        "KTX2 textures are not supported: plain colours are used",
        "some textures have no image: plain colours are used",
    )


def test_missing_uv_set_is_noted(tmp_path):
    notes = []
    for info, mesh in (({"texCoord": 2}, None), ({"texCoord": 1}, None), ({}, {})):
        document = Document()
        document.texture(png_bytes(noise(3)))
        file = read(with_texture(document, info=info, mesh=mesh), tmp_path)
        notes.append([*file.notes[-1:], file.materials[0].normal_map is None])
    assert notes == [
        ["materials[0].normalTexture is ignored: it uses TEXCOORD_2, and only 0 and 1 are supported", True],
        ["some meshes have no TEXCOORD_1: TEXCOORD_0 is used", False],
        ["some meshes have no TEXCOORD_0: their textures are sampled at one point", False],
    ]


def frames_of(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the directions of a normal map's x and y axes at each vertex: x along u, y against v."""
    signed = tangents(mesh)
    return signed[:, :3], -signed[:, 3:] * np.cross(mesh.normals, signed[:, :3])


@pytest.mark.parametrize("turned", [0.0, 0.4])
@pytest.mark.parametrize("uv_set", [0, 1])
@pytest.mark.parametrize("authored", [True, False])
def test_normal_map_axes_follow_the_orientation_of_its_image(tmp_path, authored, uv_set, turned):
    """Authored tangents have no uv set; computed tangents follow the uv set and the transform of the normal map.

    Uv coordinates that turn counter-clockwise show the image turned clockwise.
    """
    if authored and (uv_set or turned):
        return
    document = Document()
    document.texture(png_bytes(noise(3)))
    moved = {"KHR_texture_transform": {"rotation": turned, "texCoord": uv_set}}
    document.material(normalTexture={"index": 0, "extensions": moved})
    sets = {f"TEXCOORD_{uv_set}": UPRIGHT, f"TEXCOORD_{1 - uv_set}": np.random.default_rng(0).random((4, 2))}
    file_tangents = {"TANGENT": [(1, 0, 0, 1)] * 4} if authored else {}
    document.node(mesh=document.mesh(SQUARE, [(0, 0, 1)] * 4, QUAD, material=0, **sets, **file_tangents))
    right, up = frames_of(read(document, tmp_path).pieces[0].mesh)
    c, s = np.cos(turned), np.sin(turned)
    assert np.allclose(right, (c, -s, 0), atol=1e-6) and np.allclose(up, (s, c, 0), atol=1e-6)


def test_mirrored_halves_share_no_vertices_and_have_separate_bitangents(tmp_path):
    """The image is mirrored about x = 1: to the right of it, u decreases and v is unchanged."""
    positions = [(x, y, 0) for y in (0, 1) for x in (0, 1, 2)]
    uv = [(1 - abs(x - 1), 1 - y) for x, y, _ in positions]
    triangles = [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)]
    document = Document()
    document.texture(png_bytes(noise(3)))
    document.material(normalTexture={"index": 0})
    document.node(mesh=document.mesh(positions, [(0, 0, 1)] * 6, triangles, material=0, TEXCOORD_0=uv))
    mesh = read(document, tmp_path).pieces[0].mesh
    assert len(mesh.positions) == 8
    right, up = frames_of(mesh)
    for half, sign in ((mesh.triangles[:2], 1), (mesh.triangles[2:], -1)):
        assert np.allclose(right[half], (sign, 0, 0)) and np.allclose(up[half], (0, 1, 0))
    assert sorted(map(tuple, mesh.positions[mesh.triangles].reshape(-1, 9))) == sorted(
        tuple(np.ravel([positions[i] for i in t])) for t in triangles
    )


def test_tangents_do_not_depend_on_the_size_of_a_mesh():
    """Positions are scaled by 1e-9 and uv coordinates by 1e-6."""
    mesh = Mesh(np.array(SQUARE) * 1e-9, np.tile([0.0, 0, 1], (4, 1)), np.array(QUAD), np.array(UPRIGHT) * 1e-6)
    assert np.allclose(tangents(mesh), (1, 0, 0, -1))


def test_uv_coordinates_without_area_still_get_a_tangent(tmp_path):
    document = Document()
    document.texture(png_bytes(noise(3)))
    mesh = read(with_texture(document, mesh={"TEXCOORD_0": [(0.5, 0.5)] * 3}), tmp_path).pieces[0].mesh
    signed = tangents(mesh)
    assert np.allclose(np.linalg.norm(signed[:, :3], axis=1), 1) and np.allclose(signed[:, 2], 0)
    assert np.array_equal(laid_by(mesh, mesh.uv).positions, mesh.positions)


def png_head(width: int, height: int) -> bytes:
    """Return a PNG file that has only a header."""
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IEND", b"")


WHOLE = png_bytes(noise(3, height=40, width=50))


DEEP = png_bytes(noise(3, np.uint16, height=40, width=50))


BAD = {
    "missing": (None, ["images[0]", "missing.png", "no such file"]),
    "16k": (png_head(16384, 16384), ["images[0]", "the maximum is 8192 pixels per side", "reduce its size"]),
    "wide": (png_head(8193, 1), ["8193 x 1 pixels", "reduce its size"]),
    "cut off": (WHOLE[: len(WHOLE) // 2], ["images[0] is cut off or damaged", "save it again"]),
    "cut off, of 16 bits": (DEEP[: len(DEEP) // 2], ["images[0] is cut off or damaged", "save it again"]),
    "a header alone": (png_head(4, 4), ["cut off or damaged"]),
    "a JPEG that is cut off": (saved(noise(3, height=64, width=64), "JPEG")[:1500], ["cut off or damaged"]),
    "text": (b"not a picture", ["images[0] is not a PNG, JPEG or WebP image", "save it as PNG"]),
    "nothing": (b"", ["not a PNG, JPEG or WebP"]),
    "another format": (saved(noise(3), "BMP"), ["not a PNG, JPEG or WebP"]),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_image_is_a_one_line_error(tmp_path, capfd, what):
    data, parts = BAD[what]
    document = Document()
    document.texture("missing.png" if data is None else data)
    with pytest.raises(SceneFileError) as refusal:
        read(with_texture(document), tmp_path)
    line = str(refusal.value)
    assert all(part in line for part in (str(tmp_path / "a.glb"), *parts)) and "\n" not in line, line
    assert capfd.readouterr() == ("", "")


def test_error_names_an_image_by_its_uri(tmp_path):
    (tmp_path / "skin.png").write_bytes(b"?")
    document = Document()
    document.texture("skin.png")
    with pytest.raises(SceneFileError, match=r"images\[0\] \('skin.png'\) is not a PNG"):
        read(with_texture(document), tmp_path)


def test_jpeg_named_png_and_one_pixel_image_are_read(tmp_path):
    (tmp_path / "a.png").write_bytes(saved(np.full((8, 8, 3), 128, np.uint8), "JPEG"))
    for picture, shape in (("a.png", (8, 8, 4)), (png_bytes(noise(1, height=1, width=1)), (1, 1, 4))):
        document = Document()
        document.texture(picture)
        assert read(with_texture(document), tmp_path).materials[0].normal_map.texels.shape == shape


def test_images_of_a_file_share_one_pixel_limit(tmp_path, monkeypatch):
    monkeypatch.setattr(gltf_materials, "MAX_TEXELS", 29)
    document = Document()
    for _ in range(2):
        document.texture(png_bytes(noise(3)))
    with_texture(document, emissiveTexture={"index": 1})
    with pytest.raises(
        SceneFileError, match=r"images\[1\] has 5 x 3 pixels; the maximum for all images together is 29"
    ):
        read(document, tmp_path)


WRONG = {
    "no such texture": ({"index": 7}, ["normalTexture", "textures[7]", "length of textures is 1"]),
    "a wrap": ({}, ["wrap mode 7"]),
    "a transform": ({"extensions": {"KHR_texture_transform": {"scale": [1]}}}, ["scale", "2 numbers"]),
    "a set": ({"texCoord": -1}, ["texCoord", "-1"]),
}


@pytest.mark.parametrize("what", WRONG)
def test_bad_material_is_a_one_line_error(tmp_path, what):
    info, parts = WRONG[what]
    document = Document()
    document.texture(png_bytes(noise(3)), **({"wrapS": 7} if what == "a wrap" else {}))
    with pytest.raises(SceneFileError) as refusal:
        read(with_texture(document, info=info), tmp_path)
    assert all(part in str(refusal.value) for part in ("a.glb", *parts)) and "\n" not in str(refusal.value)


def test_positions_of_the_file_are_unchanged(tmp_path):
    """If the image is not mirrored, the mesh has as many vertices as the file."""
    document = Document()
    document.texture(png_bytes(noise(3)))
    document.material(normalTexture={"index": 0})
    document.node(mesh=document.mesh(POSITIONS, material=0, TEXCOORD_0=UV))
    assert np.array_equal(read(document, tmp_path).pieces[0].mesh.positions, POSITIONS)


def test_external_image_is_part_of_the_input(tmp_path):
    """A changed image makes a different input, so an image file is a companion of the file that names it."""
    (tmp_path / "skin one.png").write_bytes(png_bytes(noise(3)))
    document = Document()
    document.texture("skin%20one.png")
    document.texture(png_bytes(noise(1)))
    path = with_texture(document).write(tmp_path / "a.gltf", "beside")
    assert companions(path) == [tmp_path / "a buffer.bin", tmp_path / "skin one.png"]
