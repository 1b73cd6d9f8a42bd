"""Angular errors of published and independently computed encodings are reproduced."""

import pytest
import test_reference_figures
from test_reference_figures_slow import MORE

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

pytestmark = pytest.mark.usefixtures("rows_are_shared")


@pytest.mark.parametrize("encoding, storage, rounding, normals, mean, rms, sup", MORE)
def test_all_reference_figures_are_reproduced(normalbench, encoding, storage, rounding, normals, mean, rms, sup):
    test_reference_figures.test_the_reference_figures_are_reproduced(
        normalbench, encoding, storage, rounding, normals, mean, rms, sup
    )


@pytest.mark.parametrize("name", sorted(ENCODINGS))
def test_no_row_is_better_than_its_codes_allow(normalbench, name):
    """The RMS of N codes cannot beat the hexagonal quantiser's: effective bits never exceed the bits stored."""
    for storage in ("rgba8", "rgb10a2", "rgba8_snorm"):
        if not Codec(ENCODINGS[name], STORAGES[storage]).fits:
            continue
        row = normalbench.quality(encoding=name, storage=storage, normals="sphere", count=2**20)
        row.assert_that(effective_bits=f"at most {row['bits'] + 1e-3}")
