"""The playground's four lamp arms: the statistics of the original arms, and the shapes of the parts."""

import pytest
from test_lamp_arm import seen

from normalbench.gbuffer.scenes.built_in.playground import playground

# Of the original, measured with its own mesh: covered pixels, and those of the arms. Of the latter, percent whose
# normals have z < 0 and face away along their own ray, and percent by z from -0.9 and by n . v from -0.5, by 0.1.
COVERED, OF_ARMS = 300990, 120231


def test_the_arms_cover_as_many_pixels_as_the_original_arms():
    normals, _ = seen()
    assert playground().covered.sum() == pytest.approx(COVERED, rel=0.01)
    assert len(normals) == pytest.approx(OF_ARMS, rel=0.03)
