"""Images in glTF files that many materials share."""

from test_scene_textures import UV, noise, read
from written import TRIANGLE, Document, png_bytes

from normalbench.gbuffer.scenes.files import gltf_materials, texels


def test_image_shared_by_many_materials_is_decoded_once(tmp_path, monkeypatch):
    """Two textures use one image, in 10,000 materials."""
    document = Document()
    document.texture(png_bytes(noise(4)))
    document.json["textures"].append({"source": 0})
    document.node(mesh=document.mesh(TRIANGLE, material=9999, TEXCOORD_0=UV))
    for number in range(10_000):
        document.material(normalTexture={"index": number % 2}, emissiveTexture={"index": 0})
    unpacked = []
    monkeypatch.setattr(gltf_materials, "texels", lambda data: unpacked.append(0) or texels.texels(data))
    file = read(document, tmp_path)
    assert len(unpacked) == 1 and len(file.materials) == 10_001
    assert len({id(m.texels) for owner in file.materials[:-1] for m in (owner.normal_map, owner.emission_map)}) == 1
