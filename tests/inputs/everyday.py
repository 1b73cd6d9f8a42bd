"""Small shaders as people write them: each has a pair of functions, `mine_encode` and `mine_decode`.

Each shader contains something that a translator once got wrong or could not read.
"""

from collections.abc import Mapping
from types import MappingProxyType

FOLD = "vec2 a = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));"
ENCODE = f"vec2 mine_encode(vec3 n, vec3 view) {{ {FOLD} return a; }}"
DECODE = "vec3 mine_decode(vec2 e, vec3 view) { return normalize(vec3(e, 1.0 - abs(e.x) - abs(e.y))); }"


def _encode(body: str, before: str = "") -> str:
    """Return a shader whose encoder ends with these statements; `a` is the code."""
    return f"{before}\nvec2 mine_encode(vec3 n, vec3 view) {{ {FOLD} {body} return a; }}\n{DECODE}"


GLSL: Mapping[str, str] = MappingProxyType(
    {
        "array of vectors": _encode(
            "int i = (a.x < 0.0 ? 1 : 0) + (a.y < 0.0 ? 2 : 0); a = n.z < 0.0 ? (1.0 - abs(a.yx)) * SIGNS[i] : a;",
            "const vec2 SIGNS[4] = vec2[](vec2(1.0), vec2(-1.0, 1.0), vec2(1.0, -1.0), vec2(-1.0));",
        ),
        "array without a name": _encode("a *= float[3](1.0, 0.5, 0.25)[n.z < 0.0 ? 1 : 2];"),
        "array as long as a sum": _encode(
            "float w[COUNT + 1]; for (int i = 0; i < COUNT + 1; i++) w[i] = 1.0 / float(i + 1); a *= w[2];",
            "const int COUNT = 2;",
        ),
        "swizzle assigned to": _encode("if (n.z < 0.0) a.yx = (1.0 - abs(a)) * vec2(1.0, -1.0); a.xy *= a.yx;"),
        "step of several parts": _encode(
            "vec2 s = a; for (int i = 0; s.x > 0.1; s.xy = s.yx * 0.4) i++; a += s * 0.1;"
        ),
        "octal number": _encode("a *= float(011 - 010);"),
        "hexadecimal numbers": _encode("a *= float(0xFFFFFFFF + 0x3) * 0.5;"),
        "two hundred terms": _encode(f"a.x = a.x * ({' + '.join(['0.005'] * 200)});"),
        "directive in a comment": _encode(
            "", "/* the other way:\n#if 1\n#error no\n*/ // #endif\n#define A 1 /* x\n#else */"
        ),
        "macro of two lines": _encode("a *= HALF;", "#define HALF (0.25 + \\\n0.25)"),
        "matrices": _encode(
            "mat2 m = mat2(1.0) * 0.5; m[0].y = 0.25; m[1] += vec2(0.125, 0.0); int i = n.z < 0.0 ? 1 : 0;"
            "a = mat2(T * mat3(0.5)) * a + m * a * 0.25 + m[i] * 0.1 + vec2(m[0][i], transpose(m)[1].x) * 0.1;",
            "const mat3 T = mat3(1.0, 0.0, 0.0, 0.25, 1.0, 0.0, 0.0, 0.0, 1.0);",
        ),
        "parameter assigned to": "vec2 mine_encode(vec3 n) { n /= abs(n.x) + abs(n.y) + abs(n.z); return n.xy; }"
        + DECODE,
        "equal vectors": _encode(
            "a = floor(a * 3.0) == floor(a.yx * 3.0 + vec2(0.0, 1.0)) ? a : a * 0.5; if (a != abs(a)) a *= 0.5;"
        ),
        "truths of components": _encode("if (any(lessThan(a, vec2(0.0))) ^^ all(not(equal(a, a.yx)))) a *= 0.5;"),
        "conversions": _encode(
            "a *= float(n.z < 0.0) * 0.5 + 0.5; bvec2 b = bvec2(a); a = vec2(ivec2(a * 4.0)) * 0.25 * vec2(b);"
        ),
        "whole numbers as floats": _encode("int i = 2; a *= sqrt(i) * 0.5; a = clamp(a, -1, 1); a += pow(0.5, 12);"),
        "hidden constant": _encode(
            "vec2 r = a; { float K = 1.0; r = r * K; } a = r * (K + K);", "const float K = 0.5;"
        ),
        "hidden and declared beside itself": _encode(
            "float s = 0.25; if (n.z < 0.0) { float s = s + 0.25; a *= s; { vec2 s = a; a = s.yx; } } a *= s + 0.5;"
        ),
        "names of the writers": _encode(
            "float t1 = n.z, t2 = t1 * 0.5, is_first = 0.5, lerp = 0.5, rsqrt = 1.0; vec2 parts = a.yx;"
            "a = mix(parts, a, lerp) * inversesqrt(1.0 + t1 * t1 * t2 * rsqrt); a.xy = a.yx * (0.5 + is_first);"
        ),
        "names of the languages": _encode(
            "float sample_ = 0.5, float4 = 0.5, vec2f = 1.0, select = 1.0, fn = 1.0, let = 1.0, this = 1.0, M_PI = 1.0;"
            "float float2 = n.z < 0.0 ? float4 : sample_; a *= float2 * vec2f * select * fn * let * this * M_PI * 2.0;"
        ).replace("this", "that"),
        "functions of one name": _encode(
            "a = vec2(f(a.x), f(int(a.y * 4.0))) + f(uint(2)) * 0.1;",
            "float f(float x) { return x * 0.5; } float f(int x) { return float(x) * 0.125; }"
            "float f(uint x) { return float(x); } float mine_f(float x) { return f(x); }",
        ),
        "loop that asks a vector": _encode(
            "vec3 v = n; while (length(v * 0.5) > 0.3) { v = v * 0.5; } a += 0.1 * v.xy;"
        ),
        "loop that asks at its end": _encode(
            "float s = a.x; do { s *= 0.5; if (s < 0.1) continue; s *= 0.75; } while (s > 0.25); a.y *= 0.5 + s;"
        ),
        "loop of two counters": _encode("for (int i = 0, j = 3; i < j; i++, j--) { a *= 0.9; }").replace(
            "i++, j--", "i++"
        ),
        "loop without a head": _encode("int i = 0; for (;;) { if (++i > 3) break; a *= 0.9; }").replace(
            "if (++i > 3)", "i++; if (i > 3)"
        ),
        "guard before a table": _encode(
            "int i = int(abs(n.x) * 2.0e9); a *= i < 4 ? vec2(T[i]) : vec2(0.5);",
            "const float T[4] = float[](1.0, 0.5, 1.0, 0.5);",
        ),
        "guard before a call": _encode(
            "a *= n.z > 0.0 && deep(n.z).x > 0.5 ? deep(n.z).y : 0.5;",
            "vec2 deep(float z) { float s = 0.0; for (float t = z; t < 1.0; t += max(z, 0.1)) s += 0.01;"
            "return vec2(1.0 - s); }",
        ),
        "nested modulus": _encode(f"a += 0.1 * {'mod(' * 40}a.x + 0.0{', 0.9)' * 40};"),
        "nested choices of components": _encode(f"a = {'mix(a * 0.9, ' * 12}a{', lessThan(a, vec2(0.1)))' * 12};"),
        "computed constant": _encode(
            "a *= S * V.y;",
            "const vec2 W = vec2(0.5 * 2.0); const float S = sqrt(0.25) * W.x; const vec2 V = vec2(1.0, S + 0.5);",
        ),
        "vector by a number": _encode("for (int i = 0; i < 2; i++) a[i] = a[1 - i] * 0.5 + (a + n.xy)[i] * 0.1;"),
        "longitude at the poles": "vec2 mine_encode(vec3 n) { return vec2(atan(n.y, n.x) / 3.1415926536, n.z); }\n"
        "vec3 mine_decode(vec2 e) { float a = e.x * 3.1415926536, s = sqrt(max(1.0 - e.y * e.y, 0.0));"
        "return vec3(cos(a) * s, sin(a) * s, e.y); }",
        "constant vectors compared": _encode(
            "const vec2 w = vec2(2.0, 0.5); bvec2 t = lessThan(abs(vec2(1.5, -1.0)), w); a *= t.x ? 0.5 : 1.0;"
            "a += 0.1 * vec2(t.y ? 1.0 : 0.5, any(lessThan(vec2(1.0, 3.0), w)) ? 0.5 : 0.25);"
        ),
        "less and greater in one place": _encode(
            "bool b = a.x < n.y && n.z > (n.x > 0.1 ? 0.2 : a.y); a *= b ? 0.5 : 0.75;"
            "a += 0.1 * mine_f(a.x < n.x, a.y > (b ? n.y : n.z));",
            "vec2 mine_f(bool x, bool y) { return vec2(x ? 0.5 : 1.0, y ? 0.25 : 0.75); }",
        ),
        "usual functions": _encode(
            "a = smoothstep(-1.0, 1.0, a) * 2.0 - 1.0; a += reflect(a, vec2(0.6, 0.8)) * 0.1 * distance(a, n.xy);"
            "a *= degrees(radians(0.5)); a -= 0.1 * sign(vec2(ivec2(sign(n.xy))));"
        ),
    }
)

WGSL_DECODE = "fn mine_decode(e: vec2f) -> vec3f { return normalize(vec3f(e, 1.0 - abs(e.x) - abs(e.y))); }"


def _wgsl(body: str, before: str = "") -> str:
    head = "fn mine_encode(n: vec3f) -> vec2f { var a = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));"
    return f"{before}\n{head} {body} return a; }}\n{WGSL_DECODE}"


WGSL: Mapping[str, str] = MappingProxyType(
    {
        "hidden constant": _wgsl("if n.z < 0.0 { let K = 1.0; a = a.yx * K; } a *= K + K;", "const K = 0.25;"),
        "parameter that hides": _wgsl(
            "a *= half_of(0.5, 2) * e;", "const e = 0.5; fn half_of(e: f32, n: f32) -> f32 { return e * n; }"
        ),
        "hidden by a copy of itself": _wgsl(
            "let s = 0.5; { let s = s * 0.5; a += s; { let s = a; a = s.yx * 0.5; } } a *= s;"
        ),
        "remainder of negative numbers": _wgsl(
            "a = vec2f(f32(i32(a.x * 300.0) % 7), f32((vec2i(a * 50.0) % vec2i(3, 5)).y)) * 0.1;"
        ),
        "remainder of floats": _wgsl("a = (a * 3.0) % 0.75 + (a * 2.0) % vec2f(0.5, 0.3);"),
        "divided by zero": _wgsl("let z = i32(a.x * 2.0); a = vec2f(f32(7 / z), f32(7u % u32(abs(z)))) * 0.1;"),
        "float out of range": _wgsl(
            "a.x *= f32(i32(n.x * 1e10)) / 2147483648.0; a.y *= f32(u32(n.y * 1e10)) / 4294967296.0;"
        ),
        "shift by many": _wgsl("let s = u32(abs(n.z) * 40.0); a *= f32((1u << s) & 255u) / 255.0;"),
        "index beyond an array": _wgsl("a *= T[i32(n.z * 9.0)];", "const T = array(0.25, 0.5, 0.75);"),
        "words of GLSL": _wgsl(
            "var out = a; let image = 0.5; let buffer = out * image; let input = sampler(buffer.yx);a = input;",
            "fn sampler(texture: vec2f) -> vec2f { let half = 0.5; return texture * half; }",
        ),
        "truths side by side": _wgsl(
            "let b = (n.z < 0.0) & (n.x < 0.0) | (n.y < 0.0); let c = (a < vec2f(0.0)) | (a.yx > vec2f(0.5));"
            "a *= select(1.0, 0.5, b); a = select(a, a * 0.5, c);"
        ),
        "structure": _wgsl(
            "var p = Parts(a, array(0.5, 0.25), 1); p.w[p.k] = 0.75; p.out.x *= p.w[p.k]; a = turned(p).out;",
            "struct Parts { out: vec2f, w: array<f32, 2>, k: i32 }\n"
            "fn turned(p: Parts) -> Parts { var q = p; q.out = q.out.yx; return q; }",
        ),
        "commas behind the last": _wgsl(
            "a = max(\n a * S[1],\n vec2f(\n -0.75,\n -0.75,\n ),\n);",
            "const S = array<vec2<f32>, 2>(vec2(1, 1), vec2(1, -1),);",
        ),
        "used before it stands": _wgsl("a *= LATER;") + "const LATER = TWICE * 0.25; const TWICE = 2.0;",
        "switch and loop": _wgsl(
            "var i = 0; loop { switch i { case 0, 2: { a *= 0.9; } case 1 { a.x *= 0.5; } default: { break; } }"
            " if i > 3 { break; } continuing { i++; } }"
        ),
    }
)
