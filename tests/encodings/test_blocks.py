"""Decoders of compressed blocks, compared with texture2ddecoder, the OpenGL device and values computed by hand."""

import numpy as np
import pytest
import texture2ddecoder
from blocks import by_block, from_bgra, random_blocks

from normalbench.encodings.storages.blocks.eac import eac_r11
from normalbench.encodings.storages.blocks.rgtc import PARTS, bc4_parts, decode_bc5
from normalbench.gbuffer.gl.compressed import device_texels
from normalbench.gbuffer.gl.device import FormatError

COUNT = 10_000


# GL enums: BC7, BC5 and EAC RG11, the last two unsigned and signed.
BC7, BC5, BC5_SIGNED, RG11, RG11_SIGNED = 0x8E8C, 0x8DBD, 0x8DBE, 0x9272, 0x9273


def halves(decode, blocks, *options):
    """Return the two halves of each 16-byte block, decoded by an 8-byte decoder, (count, 16, 2)."""
    return np.stack([decode(np.ascontiguousarray(blocks[:, start : start + 8]), *options) for start in (0, 8)], axis=2)


def on_device(gl, blocks, internal_format):
    """Return blocks decoded by the OpenGL device, 1000 blocks per image, (count, 16, 4)."""
    rows = blocks.reshape(-1, 1000, 16)
    images = (device_texels(gl, row.tobytes(), (4000, 4), internal_format) for row in rows)
    return np.concatenate([by_block(image) for image in images])


def test_bc5_matches_an_independent_decoder_before_rounding():
    """texture2ddecoder truncates to 8 bits, unlike the specification: the whole 8-bit steps agree bit for bit."""
    blocks = random_blocks(COUNT, seed=3)
    expected = from_bgra(texture2ddecoder.decode_bc5(blocks.tobytes(), 4 * COUNT, 4), COUNT)[..., :2]
    wrong = (halves(bc4_parts, blocks) // PARTS != expected).any(axis=(1, 2))
    assert not wrong.any(), f"{wrong.sum()} blocks differ, the first: {blocks[wrong.argmax()]}"


def test_the_device_decodes_bc5_within_two_steps(gl):
    """llvmpipe keeps 8 bits and is one step too low if the endpoints ascend; the specification does not round.

    An H200 interpolates such endpoints at 0.3735 and 0.6265 instead of 2/5 and 3/5, and keeps 8 bits as well.
    """
    blocks = random_blocks(COUNT, seed=4)
    for internal_format, is_signed, scale in ((BC5, False, 255), (BC5_SIGNED, True, 127)):
        apart = np.abs(on_device(gl, blocks, internal_format)[..., :2] - decode_bc5(blocks, is_signed)) * scale
        # Between the ends there are 255 steps, or 254.
        most = 2 if gl.is_software else (0.4 - 0.3735) * 255 + 1
        assert apart.max() < most, f"{apart.max()} steps, signed: {is_signed}"


def test_values_between_the_endpoints_of_bc4_are_exact():
    """For the endpoints 255 and 0 the eight values are 1, 0 and sevenths; for 0 and 255 they are 0, 1 and fifths."""
    codes = sum(k % 8 << 3 * k for k in range(16)).to_bytes(6, "little")
    blocks = np.frombuffer(bytes([255, 0]) + codes + bytes([0, 255]) + codes, np.uint8).reshape(2, 8)
    down, up = bc4_parts(blocks)[:, :8] / (255 * PARTS)
    assert down == pytest.approx([1, 0, 6 / 7, 5 / 7, 4 / 7, 3 / 7, 2 / 7, 1 / 7])
    assert up == pytest.approx([0, 1, 1 / 5, 2 / 5, 3 / 5, 4 / 5, 0, 1])


def test_the_lowest_endpoint_of_signed_bc4_is_minus_one():
    """-128 means -1, as -127 does, but the endpoints are compared before that."""
    blocks = np.frombuffer(bytes([0x80, 0x81]) + bytes(6), np.uint8).reshape(1, 8)
    assert (bc4_parts(blocks, True) == -127 * PARTS).all()


def test_eac_matches_an_independent_decoder():
    """texture2ddecoder keeps the upper 8 of 11 bits."""
    blocks = random_blocks(COUNT, seed=5)
    expected = from_bgra(texture2ddecoder.decode_eacrg(blocks.tobytes(), 4 * COUNT, 4), COUNT)[..., :2]
    wrong = (halves(eac_r11, blocks) >> 3 != expected).any(axis=(1, 2))
    assert not wrong.any(), f"{wrong.sum()} blocks differ, the first: {blocks[wrong.argmax()]}"


@pytest.mark.parametrize(("internal_format", "is_signed", "one"), [(RG11, False, 2047), (RG11_SIGNED, True, 1023)])
def test_eac_matches_the_device(gl, internal_format, is_signed, one):
    """The device expands the 11 bits to 16; its own rounding is a thirtieth of a step."""
    blocks = random_blocks(COUNT, seed=6)
    apart = np.abs(on_device(gl, blocks, internal_format)[..., :2] * one - halves(eac_r11, blocks, is_signed))
    assert apart.max() < 0.04, f"{apart.max()} steps of {one}"


def test_unsupported_compressed_formats_and_sizes_are_reported(gl):
    with pytest.raises(FormatError, match="does not support this compressed format"):
        device_texels(gl, bytes(16), (4, 4), 0x1234)
    with pytest.raises(FormatError, match="texels per side"):
        device_texels(gl, b"", (1 << 20, 4), BC7)
