"""Structures and parameters that functions change, as in tangent frames, in the code of every language."""

from pathlib import Path

import pytest
from languages import RUN, require_runner
from slowly import a_tenth
from test_structures import frame_codec
from typed import codecs_named, kinds_named

from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.verify import agreement
from normalbench.encodings.catalogue import FRAME_ENCODINGS

pytestmark = pytest.mark.usefixtures("gl")


OWN = Path(__file__).parents[3] / "inputs" / "own_codes"


FAST = ("c",)


ENDINGS = [("glsl",), ("hlsl",), ("slang",), ("wgsl",)]


# Words of bits, roundings, numbers that depend on how others are rounded, and quaternions.
FRAMES = (
    ("octahedral_angle", "unorm:12:12:7:1", "nearest"),
    ("octahedral_angle", "rgb10a2", "truncate"),
    ("smallest_three", "unorm:10:10:10:2", "nearest"),
    ("qtangent", "rgba16f", "nearest"),
    ("rotation_xyz", "rgba8", "nearest"),
)


def in_languages(rows, languages) -> list:
    """Return each row with each language."""
    return [(*row, language) for row in rows for language in languages]


def agreement_of(codec, language, folder: Path, old="", new=""):
    require_runner(language)
    code = code_of(codec, language, "p")
    assert old in code.body, code.body
    (folder / code.name).write_text(code.body.replace(old, new) if old else code.body)
    return agreement(codec, language, folder / code.name, code.interface)


@pytest.mark.parametrize("name, storage, rounding, language", in_languages(FRAMES, FAST))
def test_code_for_tangent_frames_gives_the_catalogues_texels(name, storage, rounding, language, tmp_path):
    """Texels, decoded numbers, normals, tangents and handedness are compared for 2^16 frames, half of them
    mirrored."""
    verdict = agreement_of(frame_codec(name, storage, rounding), language, tmp_path)
    assert verdict.holds, verdict.says


# What is changed in C, and what must notice.
MUTANTS = {
    "a hand": ("smallest_three", "st_sign_not_zero(e.z)", "1.0f"),
    "the number that keeps a hand": ("smallest_three", "0.0009775171f", "0.0019550342f"),
    "an angle around the true normal": ("octahedral_angle", "return p_settle(frame, stored);", "return exact;"),
    "a tangent": ("octahedral_angle", "-s * n.x}", "s * n.x}"),
}


@pytest.mark.parametrize("fault", MUTANTS)
def test_a_wrong_tangent_frame_is_noticed(fault, tmp_path):
    """Each fault alone makes the comparison fail."""
    name, old, new = MUTANTS[fault]
    old = old.replace("st_", "p_")
    verdict = agreement_of(frame_codec(name, "rgb10a2"), "c", tmp_path, old, new)
    assert not verdict.holds, verdict.says


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize("ending, language", in_languages(ENDINGS, FAST))
def test_a_users_tangent_frame_code_is_written(ending, language, tmp_path):
    """The files use bitangents, out parameters, a structure or only a quaternion."""
    path = str(OWN / f"frame.{ending}")
    assert [kind.word for kind in kinds_named(path, "")] == ["frame"]
    verdict = agreement_of(frame_codec(path, "unorm:12:12:7:1"), language, tmp_path)
    assert verdict.holds, verdict.says


# Structures in each other, made anew in a branch, chosen between, returned early, and changed by a function.
STRUCTURES = """
struct Point { vec2 at; float _fold; };
struct Both { Point first, second; };

void mirror(inout Point p, out float sum, bool is_low) {
    sum = abs(p.at.x) + abs(p.at.y);
    if (!is_low) return;
    p.at.yx = (1.0 - abs(p.at)) * vec2(p.at.y < 0.0 ? -1.0 : 1.0, p.at.x < 0.0 ? -1.0 : 1.0).yx;
    p._fold = 1.0;
}

Point lower(Point p) {
    float sum;
    mirror(p, sum, true);
    if (sum > 2.0) return Point(vec2(0.0), 0.0);
    return p;
}

vec2 mine_encode(vec3 n, vec3 view) {
    Both both;
    both.first = Point(n.xy / (abs(n.x) + abs(n.y) + abs(n.z)), 0.0);
    both.second = lower(both.first);
    both.second.at.xy = both.second.at.yx;
    Point kept = n.z < 0.0 ? both.second : both.first;
    if (kept._fold == 1.0) kept.at = kept.at.xy;
    return kept.at;
}

vec3 mine_decode(vec2 e, vec3 view) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float t = max(-n.z, 0.0);
    n.xy += vec2(n.x < 0.0 ? t : -t, n.y < 0.0 ? t : -t);
    return normalize(n);
}
"""


@pytest.mark.parametrize("language", FAST)
def test_structures_in_users_shaders_are_written(language, tmp_path):
    (tmp_path / "mine.glsl").write_text(STRUCTURES)
    (codec,) = codecs_named(str(tmp_path / "mine.glsl"), "rg16", "nearest")
    verdict = agreement_of(codec, language, tmp_path)
    assert verdict.holds, verdict.says


OTHERS = [language for language in RUN if language not in FAST]


# Words of bits, and half floats: the rest of the catalogue is drawn.
FIRST = [row for row in FRAMES if row[0] in ("smallest_three", "qtangent")]


REST = in_languages([row for row in FRAMES if row not in FIRST], OTHERS)


# Of users' files that in HLSL, whose structures are read by the most rules.
OWN_FIRST, OWN_REST = (
    in_languages([("hlsl",)], OTHERS),
    in_languages([ending for ending in ENDINGS if ending != ("hlsl",)], OTHERS),
)


@pytest.mark.parametrize("name, storage, rounding, language", [*in_languages(FIRST, OTHERS), *a_tenth(REST)])
def test_code_for_tangent_frames_gives_the_catalogues_texels_in_any_language(
    name, storage, rounding, language, tmp_path
):
    test_code_for_tangent_frames_gives_the_catalogues_texels(name, storage, rounding, language, tmp_path)


def test_code_for_every_tangent_frame_encoding_is_written(tmp_path):
    """Each encoding is written in C, in its default storage."""
    for name in FRAME_ENCODINGS:
        verdict = agreement_of(frame_codec(name, ""), "c", tmp_path)
        assert verdict.holds, f"{name}: {verdict.says}"


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize("ending, language", [*OWN_FIRST, *a_tenth(OWN_REST)])
def test_a_users_tangent_frame_code_is_written_in_any_language(ending, language, tmp_path):
    test_a_users_tangent_frame_code_is_written(ending, language, tmp_path)


@pytest.mark.parametrize("language", OTHERS)
def test_structures_in_users_shaders_are_written_in_any_language(language, tmp_path):
    test_structures_in_users_shaders_are_written(language, tmp_path)
