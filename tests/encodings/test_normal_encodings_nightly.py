"""Normal encodings: both backends have the same errors, and every direction comes back."""

import pytest
import test_normal_encodings
from parity.normals import PACKED
from test_normal_encodings import KINDS, params

from normalbench.encodings.storages.storage import STORAGES

WHOLE = [name for name, storage in STORAGES.items() if not storage.is_packed and name != "rgba32f"]


# Every storage with one encoding, and every rounding: what an encoding's codes are test_parity.py compares.
BACK_ENDS = [
    *params([*WHOLE, *PACKED], names=["octahedral"]),
    *params(["rgba8", "rg16f"], ["truncate"], names=["octahedral", "spheremap"]),
    *params(["rgba8"], ["truncate_half"], names=["octahedral", "spheremap"]),
]


DONE = [param.id for param in KINDS]


@pytest.mark.parametrize("codec", [param for param in BACK_ENDS if param.id not in DONE])
@pytest.mark.usefixtures("gl")
def test_both_backends_give_the_same_psnr_in_every_storage(codec):
    test_normal_encodings.test_both_backends_give_the_same_psnr(codec)
