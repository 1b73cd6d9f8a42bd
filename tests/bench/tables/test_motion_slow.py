"""`normalbench motion`: the wobble of a code, of highlights and of images, animations, and bad input."""

import pytest
import test_motion
from test_motion import wobble

pictures = test_motion.pictures
rows = test_motion.rows


# Static RMS in degrees, and the wobble at 0.01, 0.05, 0.25 and 1 degree a frame: of a prototype in NumPy that this
# table was made after, with two channels of 8 bits in view space.
PROTOTYPE = {
    "octahedral": (0.380, (0.095, 0.206, 0.418, 0.476)),
    "spheremap": (0.374, (0.089, 0.197, 0.399, 0.418)),
}


@pytest.mark.parametrize("name", PROTOTYPE)
def test_the_wobble_is_that_of_the_prototype(name):
    """Within 3 %: normals over z >= 0.2 of the first frame, 32 frames of yaw."""
    static, wobbles = PROTOTYPE[name]
    rows = [wobble(name, turn=turn, count=2**16) for turn in (0.01, 0.05, 0.25, 1.0)]
    assert rows[0]["static_rms_deg"] == pytest.approx(static, rel=0.03)
    assert [row["wobble_deg"] for row in rows] == pytest.approx(wobbles, rel=0.03)
