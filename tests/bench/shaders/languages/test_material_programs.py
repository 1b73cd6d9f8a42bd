"""Material files: code shared by their programs, and each program separately."""

import pytest
from typed import Source, translated

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.languages.blocks import programs_of

pytestmark = pytest.mark.usefixtures("in_this_process")

COMMON = "HLSLINCLUDE\n#define SCALE 1.0\nENDHLSL\n"
OTHER = "HLSLPROGRAM\n#define SCALED(x) gone(x)\nfloat4 frag() : SV_Target { return SCALED(2.0); }\nENDHLSL\n"
PAIR = """HLSLPROGRAM
#define SCALED(x) ((x) * SCALE)
float2 PackDir(float3 n) { return SCALED(n.xy); }
float3 UnpackDir(float2 e) { return float3(e, sqrt(saturate(1.0 - dot(e, e)))); }
ENDHLSL
"""


def material(folder, *blocks):
    path = folder / "mine.shader"
    path.write_text(f'Shader "Mine" {{ SubShader {{ Pass {{\n{"".join(blocks)}}} }} }}\n')
    return path


def test_program_has_the_shared_code_and_keeps_line_numbers(tmp_path):
    path = material(tmp_path, PAIR, OTHER, COMMON)
    first, other = programs_of(Source(path))
    assert first.text.count("\n") == other.text.count("\n") == Source(path).text.count("\n")
    assert "PackDir" in first.text and "SCALE 1.0" in first.text and "frag" not in first.text
    assert "frag" in other.text and "SCALE 1.0" in other.text and "PackDir" not in other.text


def test_a_file_without_blocks_is_a_program(tmp_path):
    path = tmp_path / "mine.hlsl"
    path.write_text("float x;")
    (only,) = programs_of(Source(path))
    assert only.text == "float x;\n"


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize("blocks", [(COMMON, OTHER, PAIR), (COMMON, PAIR, OTHER)])
def test_macros_in_one_program_do_not_affect_another(tmp_path, blocks):
    translation = translated(material(tmp_path, *blocks))
    assert [name for name, _ in translation.functions] == ["PackDir", "UnpackDir"]


@pytest.mark.usefixtures("slang")
def test_error_in_the_pair_is_reported_at_its_line(tmp_path):
    """The pair may be in any program of the file."""
    path = material(tmp_path, OTHER, PAIR.replace("SCALED(n.xy)", "gone(n.xy)"))
    with pytest.raises(UsageError, match=r"mine\.shader:8:35: .*gone"):
        translated(path)
