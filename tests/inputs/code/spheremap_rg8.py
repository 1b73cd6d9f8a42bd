"""Spheremap in RG8, written by hand: input for tests of the runners, and the reference for the other languages."""

import numpy as np

F = np.float32


def spheremap_rg8_encode(n):
    with np.errstate(divide="ignore", invalid="ignore"):
        code = n[:, :2] * (F(2) / np.sqrt(F(8) * n[:, 2:] + F(8)))
    return np.where(n[:, 2:] > -1, code, np.array([1, 0], np.float32))


def spheremap_rg8_pack(code):
    steps = np.rint(np.clip(code * F(0.5) + F(0.5), 0, 1) * F(255)).astype(np.uint32)
    return steps[:, 0] | steps[:, 1] << 8


def spheremap_rg8_unpack(words):
    return np.stack([words & 255, words >> 8 & 255], axis=1).astype(np.float32) * (F(1) / F(255)) * F(2) - F(1)


def spheremap_rg8_decode(e):
    fenc = e * F(2)
    f = np.minimum(fenc[:, 0] * fenc[:, 0] + fenc[:, 1] * fenc[:, 1], F(4))[:, None]
    return np.concatenate([fenc * np.sqrt(F(1) - f / F(4)), F(1) - f / F(2)], axis=1)


def spheremap_rg8_to_target(code):
    return np.concatenate([code * F(0.5) + F(0.5), np.zeros_like(code[:, :1]), np.ones_like(code[:, :1])], axis=1)


def spheremap_rg8_from_target(texel):
    return texel[:, :2] * F(2) - F(1)
