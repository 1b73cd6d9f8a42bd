"""A translation is measured once a second compiler has given the same."""

import numpy as np
import pytest

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.ground.directions import directions
from normalbench.bench.ground.output import cache as kept
from normalbench.bench.subjects.codecs import second_look
from normalbench.bench.subjects.codecs.first_look import first_look
from normalbench.bench.subjects.codecs.user_encodings import read_encoding
from normalbench.gbuffer.codecs.codec_passes import exact_values
from normalbench.gbuffer.gl.device import device

pytestmark = pytest.mark.usefixtures("gl", "in_this_process")

DECODE = "float3 MineDecode(float2 e) { return normalize(float3(e, 1.0 - abs(e.x) - abs(e.y))); }"
SUM = "n /= abs(n.x) + abs(n.y) + abs(n.z);"
MATRICES = "static const float2x2 A = { 1, 5, 5, 1 };\nstatic const float2x2 B = { 1, 0, 0, 0.5 };\n"


@pytest.fixture(autouse=True)
def empty_cache(tmp_path, monkeypatch):
    """What was found before is not what these tests find."""
    monkeypatch.setattr(kept, "folder", lambda: tmp_path / "cache")


def codes(path, by=""):
    n = np.pad(directions(), ((0, 0), (0, 1)))
    return exact_values(device(), read_encoding(path, "", by=by), n, n, n)[0][:, :2]


def hlsl_of(folder, name, body):
    path = folder / f"{name}.hlsl"
    path.write_text(f"{MATRICES}float2 MineEncode(float3 n) {{ {SUM} {body} }}\n{DECODE}\n")
    return path


def test_codes_on_the_two_sides_of_a_seam_are_no_difference():
    """-0 and 0, and normals that rounding moves across a seam, are on either side of it; a changed constant is not."""
    n = directions()

    def folded(given):
        return np.where(given[:, 2:] < 0, given[:, :2] * 0.5, given[:, :2])

    moved = n.copy()
    moved[np.abs(n[:, 2]) < 1e-7, 2] *= -1
    assert second_look._first_apart(folded, n, folded(n), folded(moved), 2.0**-16) is None
    at = second_look._first_apart(folded, n, folded(n), folded(n) * 1.001, 2.0**-16)
    assert at is not None and angles_deg(n[at : at + 1], n[at : at + 1])[0] == 0


UNDEFINED = "it divides a whole number by 0, of some normal; its language does not define that"


@pytest.mark.usefixtures("hlsl", "slang")
def test_a_whole_number_divided_by_zero_is_refused_in_a_line(tmp_path):
    said = first_look(hlsl_of(tmp_path, "mine", "int k = int(n.x * 0.0); return n.xy + (7 / k) * 1e-12;"))["error"]
    assert said.endswith(UNDEFINED)
