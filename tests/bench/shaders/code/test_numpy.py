"""Control flow of a user's GLSL in NumPy, where all normals go through the same lines."""

import numpy as np
import pytest

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.verify import agreement
from normalbench.bench.subjects.codecs.names import codecs_named

DECODE = """
vec3 mine_decode(vec2 e, vec3 view) {
    return normalize(vec3(e, 1.0 - abs(e.x) - abs(e.y)));
}
"""
# What each gives depends on which way a normal takes.
PROGRAMS = {
    "returns in branches": """
vec2 mine_encode(vec3 n, vec3 view) {
    if (n.x > 0.5) {
        if (n.y > 0.25) return n.yx;
        float twice = n.z * 2.0;
        if (twice > 0.5) { return vec2(twice * 0.25, n.y); }
    } else if (n.x < -0.5) {
        return n.zz * 0.5;
    }
    vec2 p = n.xy;
    if (n.z < 0.0) p = -p;
    return p * 0.5;
}""",
    "break and continue": """
vec2 mine_encode(vec3 n, vec3 view) {
    float sum = 0.0;
    int turns = 0;
    for (int i = 0; i < 12; ++i) {
        if (i == 3 && n.x > 0.0) continue;
        if (n.y > 0.0) {
            if (sum > 0.5) break;
            sum += 0.125;
            if (n.z > 0.25) { turns += 2; continue; }
        }
        sum += abs(n.z) * 0.0625;
        turns++;
    }
    return vec2(clamp(sum, 0.0, 1.0), float(turns) / 32.0);
}""",
    "returns in nested loops": """
float found(vec3 n) {
    int i = 0;
    while (i < 5) {
        for (int j = 0; j < 5; j += 1) {
            if (j > 3) break;
            if (float(i * 4 + j) * 0.05 > abs(n.x)) return float(i - j) * 0.1;
            if (n.y < -0.5 && i == 2) continue;
            if (n.z < -0.75) return -0.5;
        }
        i++;
    }
    return 1.0;
}
vec2 mine_encode(vec3 n, vec3 view) { return vec2(found(n), found(n.zxy)); }""",
    "a loop of its own length": """
vec2 mine_encode(vec3 n, vec3 view) {
    float x = abs(n.x) + 0.01;
    int steps = 0;
    if (n.z > 0.0) {
        while (x < 1.0) { x *= 2.0; steps++; }
    }
    return vec2(x * 0.4, float(steps) * 0.1);
}""",
    "arrays and matrices": """
const float WEIGHTS[4] = float[4](0.1, 0.2, 0.3, 0.4);
const vec2 CORNERS[3] = vec2[3](vec2(0.0, 0.5), vec2(0.25, -0.5), vec2(-0.75, 0.125));
vec2 mine_encode(vec3 n, vec3 view) {
    int at = int(abs(n.x) * 3.99);
    mat2 turn = mat2(0.6, 0.8, -0.8, 0.6);
    float kept[3];
    for (int i = 0; i < 3; i++) kept[i] = n[i] * WEIGHTS[i + 1];
    kept[at % 3] *= 0.5;
    vec2 p = turn * vec2(kept[0], kept[at % 3]) + CORNERS[min(at, 2)] * 0.25;
    p.y = (n.xy * turn).x * 0.5;
    vec3 q = vec3(p, n.z);
    q.zx = q.xz;
    q[at % 3] += 0.0625;
    return q.xy * 0.5 + transpose(turn)[1] * 0.125;
}""",
    "whole numbers": """
vec2 mine_encode(vec3 n, vec3 view) {
    int a = int(n.x * 1000.0), b = int(n.y * 10.0) + 11;
    uint bits = uint(abs(n.z) * 65535.0);
    int mixed = (a / b) * 3 + a % 7 * int(a > 0);
    bits = (bits << 3) ^ (bits >> uint(b & 7)) | 5u;
    int low = int(bits & 255u) - 128;
    return vec2(float(mixed % 64 * int(mixed > 0)) / 64.0, float(low) / 128.0);
}""",
    "what is no number": """
vec2 mine_encode(vec3 n, vec3 view) {
    return vec2(max(sqrt(n.x), 0.25), clamp(sqrt(n.y), 0.0, 1.0)) * 0.5 + min(0.25, sqrt(n.z));
}""",
    "scalars as vectors": """
vec2 mine_encode(vec3 n, vec3 view) {
    return vec2(length(n.x) + reflect(n.y, 0.5) * 0.25, distance(n.y, 0.25) * 0.5 + dot(n.x, n.z) * 0.25);
}""",
    "arrays of matrices": """
vec2 mine_encode(vec3 n, vec3 view) {
    mat2 m[2] = mat2[2](mat2(0.1, 0.2, 0.3, 0.4), mat2(n.x, 0.6, 0.7, -0.5));
    return (m[n.z > 0.0 ? 1 : 0] * n.xy + m[1][0] * 0.1) * 0.5;
}""",
    "unusual numbers": """
vec2 mine_encode(vec3 n, vec3 view) {
    int a = floatBitsToInt(n.x) & 0x80000000;
    uint b = uint(abs(n.x) * 100.0) & -4u, c = uint(abs(n.y) * 100.0) << 33;
    return vec2(a != 0 ? 0.5 : float(b) / 128.0, float(c & 255u) / 256.0 + float(-1u >> 8) / 67108864.0);
}""",
    "a called loop that ends for some normals alone": """
float doubled(float x) { while (x < 1.0) x *= 2.0; return x; }
float at_once(float x) { return doubled(x) * 0.25; }
bool is_large(float x) { return doubled(x) > 1.5; }
vec2 mine_encode(vec3 n, vec3 view) {
    float sum = 0.0;
    if (n.x > 0.0) { sum = at_once(n.x); }
    for (int i = 0; i < 3; i++) {
        if (n.y <= 0.0) break;
        sum += doubled(n.y) * 0.125;
    }
    float w = n.x + 0.5;
    for (int i = 0; w > 0.0 && doubled(w) > 1.25; i++) w -= 0.25;
    sum += w * 0.0625;
    bool a = n.z > 0.0 && is_large(n.z), b = n.z <= 0.0 || is_large(n.z);
    if (n.x > 0.5) return vec2(sum * 0.5, a ? 0.5 : 0.25);
    return vec2(n.z > 0.0 ? doubled(n.z) * 0.25 : sum * 0.25, b ? 0.5 : 0.25);
}""",
    "lines behind what leaves": """
vec2 mine_encode(vec3 n, vec3 view) {
    float s = 0.0;
    for (int i = 0; i < 5; i++) {
        if (n.x > 0.0) { break; s = 1.0; }
        s += 0.1;
        if (n.y > 0.3) { continue; s += 5.0; }
    }
    if (n.z > 0.5) { return vec2(s, 0.5); s = 3.0; }
    return vec2(s, n.y);
}""",
}


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("program", PROGRAMS)
def test_every_normal_goes_its_own_way(program, tmp_path):
    """2^16 normals have the codes that OpenGL gives them."""
    (tmp_path / "mine.glsl").write_text(PROGRAMS[program] + DECODE)
    (codec,) = codecs_named(str(tmp_path / "mine.glsl"), "rg16", "nearest")
    code = code_of(codec, "python", "p")
    path = tmp_path / code.name
    path.write_text(code.body)
    found = agreement(codec, "python", path, code.interface)
    assert found.holds and found.differing < 200, f"{found.says}\n{code.body}"


def test_a_file_is_plain_numpy():
    """It imports NumPy and the standard library alone, and takes any shape of arrays, and lists."""
    (codec,) = codecs_named("octahedral", "rgb10a2", "nearest")
    code = code_of(codec, "python", "mine")
    text = code.text(["Made by hand.", "Twice."])
    assert text.startswith("# Made by hand.\n# Twice.\n")
    assert "jax" not in text and "normalbench" not in text
    module: dict = {}
    exec(compile(text, "mine.py", "exec"), module)
    n = np.random.default_rng(0).normal(size=(3, 5, 3))
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    assert module["mine_pack"](module["mine_encode"](n)).shape == (3, 5)
    (one,) = module["mine_pack"](module["mine_encode"]([[1.0, 0.0, 0.0]]))
    assert one == 1023 | 512 << 10 and one.dtype == np.uint32
    back = module["mine_decode"](module["mine_unpack"](module["mine_pack"](module["mine_encode"](n))))
    assert back.dtype == np.float32 and np.abs(back - n).max() < 0.01


def test_a_function_that_changes_what_it_is_given_stands_in_a_line_of_its_own(tmp_path):
    (tmp_path / "mine.glsl").write_text(
        "float halved(inout vec2 p) { p *= 0.5; return p.x; }\n"
        "vec2 mine_encode(vec3 n, vec3 view) { vec2 p = n.xy; p.y += 2.0 * halved(p); return p; }\n" + DECODE
    )
    (codec,) = codecs_named(str(tmp_path / "mine.glsl"), "rg16", "nearest")
    with pytest.raises(UsageError, match="changes what it is given: call it in a line of its own"):
        code_of(codec, "python", "p")
