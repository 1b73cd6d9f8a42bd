"""Codes of normals: both back ends have the same errors, and every direction comes back."""

import pytest
import test_normal_encodings
from test_normal_encodings import BACK_ENDS, KINDS

DONE = [param.id for param in KINDS]


@pytest.mark.parametrize("codec", [param for param in BACK_ENDS if param.id not in DONE])
@pytest.mark.usefixtures("gl")
def test_the_two_back_ends_give_the_same_psnr_in_every_storage(codec):
    test_normal_encodings.test_the_two_back_ends_give_the_same_psnr(codec)
