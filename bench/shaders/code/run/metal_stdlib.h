// The part of Metal's standard library that a codec uses, for clang: by its vectors with swizzles, and by builtins, which
// round as IEEE 754 has it. What a file does here is the arithmetic of its text; Metal's compiler may reorder that.
// From Apple, Metal Shading Language Specification, chapters 2 and 6.
#pragma once
#include <stddef.h>
#include <stdint.h>

#define constant static const
#define device
#define thread
#define RUN_EACH(N, ...) for (int i = 0; i < (N); ++i) __VA_ARGS__

namespace metal {
typedef unsigned int uint;
typedef unsigned short ushort;
typedef unsigned char uchar;
template <class T> using of2 = T __attribute__((ext_vector_type(2)));
template <class T> using of3 = T __attribute__((ext_vector_type(3)));
template <class T> using of4 = T __attribute__((ext_vector_type(4)));
using float2 = of2<float>; using float3 = of3<float>; using float4 = of4<float>;
using int2 = of2<int>; using int3 = of3<int>; using int4 = of4<int>;
using uint2 = of2<uint>; using uint3 = of3<uint>; using uint4 = of4<uint>;
using ushort2 = of2<ushort>; using ushort3 = of3<ushort>; using ushort4 = of4<ushort>;
// A comparison of vectors gives whole numbers, -1 for true.
using bool2 = int2; using bool3 = int3; using bool4 = int4;

template <class T> struct sized { static constexpr int count = 1; using element = T; };
#define RUN_SIZED(V, E, N) template <> struct sized<V> { static constexpr int count = N; using element = E; };
#define RUN_SIZES(E) RUN_SIZED(E##2, E, 2) RUN_SIZED(E##3, E, 3) RUN_SIZED(E##4, E, 4)
RUN_SIZES(float) RUN_SIZES(int) RUN_SIZES(uint) RUN_SIZES(ushort)

template <class T, int N> struct element_of {
    static auto get(T v, int i) { return v[i]; }
};
template <class T> struct element_of<T, 1> {
    static T get(T v, int) { return v; }
};

// A vector of parts: of one number, of a vector of its size, or of numbers and vectors one after another.
template <class V, class... Parts> inline V made_of(Parts... parts) {
    using E = typename sized<V>::element;
    V made = (V)(E)0;
    int at = 0;
    auto append = [&](auto part) {
        using P = decltype(part);
        RUN_EACH(sized<P>::count, made[at++] = (E)element_of<P, sized<P>::count>::get(part, i));
    };
    (append(parts), ...);
    if (at == 1) RUN_EACH(sized<V>::count, made[i] = made[0]);
    return made;
}

template <class To, class From> inline To as_type(From v) {
    static_assert(sizeof(To) == sizeof(From), "as_type keeps the bits");
    To made;
    __builtin_memcpy(&made, &v, sizeof made);
    return made;
}

// Functions of numbers, and of vectors by component.
#define RUN_VECTORS1(NAME, T)                                                                      \
    inline T##2 NAME(T##2 a) { return T##2{NAME(a.x), NAME(a.y)}; }                                \
    inline T##3 NAME(T##3 a) { return T##3{NAME(a.x), NAME(a.y), NAME(a.z)}; }                     \
    inline T##4 NAME(T##4 a) { return T##4{NAME(a.x), NAME(a.y), NAME(a.z), NAME(a.w)}; }
#define RUN_VECTORS2(NAME, T)                                                                      \
    inline T##2 NAME(T##2 a, T##2 b) { return T##2{NAME(a.x, b.x), NAME(a.y, b.y)}; }              \
    inline T##3 NAME(T##3 a, T##3 b) { return T##3{NAME(a.x, b.x), NAME(a.y, b.y), NAME(a.z, b.z)}; } \
    inline T##4 NAME(T##4 a, T##4 b) {                                                             \
        return T##4{NAME(a.x, b.x), NAME(a.y, b.y), NAME(a.z, b.z), NAME(a.w, b.w)};               \
    }
#define RUN_FLOAT1(NAME, VALUE) inline float NAME(float a) { return VALUE; } RUN_VECTORS1(NAME, float)
#define RUN_FLOAT2(NAME, VALUE) inline float NAME(float a, float b) { return VALUE; } RUN_VECTORS2(NAME, float)
#define RUN_WHOLE2(NAME, T, VALUE) inline T NAME(T a, T b) { return VALUE; } RUN_VECTORS2(NAME, T)

#define RUN_MATHS                                                                                  \
    RUN_FLOAT1(sqrt, __builtin_sqrtf(a)) RUN_FLOAT1(rsqrt, 1.0f / __builtin_sqrtf(a))              \
    RUN_FLOAT1(exp2, __builtin_exp2f(a)) RUN_FLOAT1(log2, __builtin_log2f(a))                      \
    RUN_FLOAT1(exp, __builtin_expf(a)) RUN_FLOAT1(log, __builtin_logf(a))                          \
    RUN_FLOAT1(sin, __builtin_sinf(a)) RUN_FLOAT1(cos, __builtin_cosf(a))                          \
    RUN_FLOAT1(tan, __builtin_tanf(a)) RUN_FLOAT1(acos, __builtin_acosf(a))                        \
    RUN_FLOAT1(asin, __builtin_asinf(a)) RUN_FLOAT1(atan, __builtin_atanf(a))                      \
    RUN_FLOAT2(atan2, __builtin_atan2f(a, b)) RUN_FLOAT2(pow, __builtin_powf(a, b))
RUN_MATHS
namespace precise { RUN_MATHS }
namespace fast { RUN_MATHS }

RUN_FLOAT1(fabs, __builtin_fabsf(a)) RUN_FLOAT1(abs, __builtin_fabsf(a))
RUN_FLOAT1(floor, __builtin_floorf(a)) RUN_FLOAT1(ceil, __builtin_ceilf(a))
RUN_FLOAT1(trunc, __builtin_truncf(a)) RUN_FLOAT1(rint, __builtin_rintf(a))
RUN_FLOAT1(round, __builtin_roundf(a)) RUN_FLOAT1(fract, __builtin_fminf(a - __builtin_floorf(a), 0x1.fffffep-1f))
RUN_FLOAT1(sign, a > 0.0f ? 1.0f : a < 0.0f ? -1.0f : a == 0.0f ? a : 0.0f)
// Of a number and a NaN the number.
RUN_FLOAT2(fmin, __builtin_fminf(a, b)) RUN_FLOAT2(fmax, __builtin_fmaxf(a, b))
RUN_FLOAT2(min, __builtin_fminf(a, b)) RUN_FLOAT2(max, __builtin_fmaxf(a, b))
RUN_FLOAT2(step, b < a ? 0.0f : 1.0f) RUN_FLOAT2(copysign, __builtin_copysignf(a, b))
RUN_WHOLE2(min, int, a < b ? a : b) RUN_WHOLE2(max, int, a < b ? b : a)
RUN_WHOLE2(min, uint, a < b ? a : b) RUN_WHOLE2(max, uint, a < b ? b : a)
inline int abs(int a) { return a < 0 ? -a : a; }
RUN_VECTORS1(abs, int)
inline bool isnan(float a) { return a != a; }
inline bool isinf(float a) { return __builtin_fabsf(a) == __builtin_inff(); }
inline bool isfinite(float a) { return __builtin_fabsf(a) < __builtin_inff(); }
inline bool signbit(float a) { return as_type<uint>(a) >> 31 != 0u; }
inline float fma(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
inline float ldexp(float a, int power) { return __builtin_ldexpf(a, power); }

template <class T> inline T clamp(T a, T low, T high) { return min(max(a, low), high); }
inline float saturate(float a) { return clamp(a, 0.0f, 1.0f); }
inline float2 saturate(float2 a) { return clamp(a, (float2)0.0f, (float2)1.0f); }
inline float3 saturate(float3 a) { return clamp(a, (float3)0.0f, (float3)1.0f); }
inline float4 saturate(float4 a) { return clamp(a, (float4)0.0f, (float4)1.0f); }
template <class T> inline T mix(T a, T b, T share) { return a + (b - a) * share; }

inline float dot(float2 a, float2 b) { return a.x * b.x + a.y * b.y; }
inline float dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float dot(float4 a, float4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
inline float3 cross(float3 a, float3 b) { return a.yzx * b.zxy - a.zxy * b.yzx; }
template <class V> inline float length(V v) { return __builtin_sqrtf(dot(v, v)); }
template <class V> inline float distance(V a, V b) { return length(a - b); }
template <class V> inline V reflect(V incident, V normal) { return incident - 2.0f * dot(normal, incident) * normal; }
inline float smoothstep(float low, float high, float a) {
    float share = saturate((a - low) / (high - low));
    return share * share * (3.0f - 2.0f * share);
}
template <class V> inline V smoothstep(V low, V high, V a) {
    for (int i = 0; i < sized<V>::count; ++i) a[i] = smoothstep((float)low[i], (float)high[i], (float)a[i]);
    return a;
}
template <class V> inline V normalize(V v) { return v * (1.0f / __builtin_sqrtf(dot(v, v))); }

// The second where the condition holds.
template <class T> inline T select(T a, T b, bool chosen) { return chosen ? b : a; }
#define RUN_SELECT(T, N)                                                                           \
    inline T##N select(T##N a, T##N b, int##N chosen) {                                            \
        T##N made = a;                                                                             \
        RUN_EACH(N, made[i] = chosen[i] ? b[i] : a[i]);                                            \
        return made;                                                                               \
    }
RUN_SELECT(float, 2) RUN_SELECT(float, 3) RUN_SELECT(float, 4)
RUN_SELECT(int, 2) RUN_SELECT(int, 3) RUN_SELECT(int, 4)
RUN_SELECT(uint, 2) RUN_SELECT(uint, 3) RUN_SELECT(uint, 4)
inline bool any(bool a) { return a; }
inline bool all(bool a) { return a; }
template <class V> inline bool any(V v) { return v.x || v.y || (sized<V>::count > 2 && v[2]) || (sized<V>::count > 3 && v[3]); }
template <class V> inline bool all(V v) { return v.x && v.y && (sized<V>::count < 3 || v[2]) && (sized<V>::count < 4 || v[3]); }

// A float of 16 bits, rounded to the nearest, of ties to the even one; computed in 32 bits.
struct half {
    ushort bits;
    half() = default;
    half(float a) {
        uint word = as_type<uint>(a), sign = word >> 16 & 0x8000u, magnitude = word & 0x7FFFFFFFu;
        uint made = magnitude > 0x7F800000u ? 0x7E00u : 0x7C00u;
        if (magnitude < 0x38800000u)
            made = (uint)__builtin_rintf(as_type<float>(magnitude) * 0x1p24f);
        else if (magnitude < 0x47800000u)
            made = (magnitude + 0xFFFu + (magnitude >> 13 & 1u) - 0x38000000u) >> 13;
        bits = (ushort)(sign | made);
    }
    operator float() const {
        uint magnitude = bits & 0x7FFFu, sign = (uint)(bits & 0x8000u) << 16;
        float made = magnitude < 0x400u ? (float)magnitude * 0x1p-24f : as_type<float>((magnitude << 13) + 0x38000000u);
        if (magnitude >= 0x7C00u) made = as_type<float>(0x7F800000u | magnitude << 13);
        return as_type<float>(as_type<uint>(made) | sign);
    }
};
struct half2 {
    half x, y;
    half2(float2 a) : x(a.x), y(a.y) {}
    half2(float a, float b) : x(a), y(b) {}
    operator float2() const { return float2{(float)x, (float)y}; }
};
template <> inline uint as_type<uint, half2>(half2 v) { return (uint)v.x.bits | (uint)v.y.bits << 16; }
template <> inline half2 as_type<half2, uint>(uint word) {
    half2 made(0.0f, 0.0f);
    made.x.bits = (ushort)word, made.y.bits = (ushort)(word >> 16);
    return made;
}
template <> struct sized<half2> { static constexpr int count = 2; using element = half; };
template <> struct element_of<half2, 2> {
    static float get(half2 v, int i) { return i ? v.y : v.x; }
};

enum class access { sample, read };
template <class T, access A = access::sample> struct texture2d {
    const float *texels;
    uint width, height;
    of4<T> read(uint2 at, uint = 0) const {
        const float *texel = texels + 4 * ((size_t)at.y * width + at.x);
        return of4<T>{texel[0], texel[1], texel[2], texel[3]};
    }
    uint get_width() const { return width; }
    uint get_height() const { return height; }
};

// Of columns, as Metal's are.
template <bool IS_TRUE> struct only_if {};
template <> struct only_if<true> { using type = void; };
template <class V, int N> struct square {
    V columns[N];
    template <class... C, class = typename only_if<sizeof...(C) == N>::type> square(C... given) : columns{given...} {}
    V &operator[](int i) { return columns[i]; }
    V operator[](int i) const { return columns[i]; }
};
using float2x2 = square<float2, 2>; using float3x3 = square<float3, 3>; using float4x4 = square<float4, 4>;
template <class V, int N> inline V operator*(square<V, N> m, V v) {
    V sum = m[0] * v[0];
    for (int i = 1; i < N; ++i) sum = sum + m[i] * v[i];
    return sum;
}
template <class V, int N> inline V operator*(V v, square<V, N> m) {
    V made;
    for (int i = 0; i < N; ++i) made[i] = dot(v, m[i]);
    return made;
}
template <class V, int N> inline square<V, N> operator*(square<V, N> a, square<V, N> b) {
    for (int i = 0; i < N; ++i) b[i] = a * b[i];
    return b;
}
template <class V, int N> inline square<V, N> operator*(square<V, N> m, float s) {
    for (int i = 0; i < N; ++i) m[i] = m[i] * s;
    return m;
}
template <class V, int N> inline square<V, N> operator*(float s, square<V, N> m) { return m * s; }
template <class V, int N> inline square<V, N> operator+(square<V, N> a, square<V, N> b) {
    for (int i = 0; i < N; ++i) a[i] = a[i] + b[i];
    return a;
}
template <class V, int N> inline square<V, N> operator-(square<V, N> a, square<V, N> b) { return a + b * -1.0f; }
template <class V, int N> inline square<V, N> transpose(square<V, N> m) {
    square<V, N> made = m;
    for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) made[i][j] = m[j][i];
    return made;
}
}  // namespace metal

// float3(a, b, c) is a constructor in Metal, which clang's vectors lack; float3 alone stays the type.
#define float2(...) made_of<metal::float2>(__VA_ARGS__)
#define float3(...) made_of<metal::float3>(__VA_ARGS__)
#define float4(...) made_of<metal::float4>(__VA_ARGS__)
#define int2(...) made_of<metal::int2>(__VA_ARGS__)
#define int3(...) made_of<metal::int3>(__VA_ARGS__)
#define int4(...) made_of<metal::int4>(__VA_ARGS__)
#define uint2(...) made_of<metal::uint2>(__VA_ARGS__)
#define uint3(...) made_of<metal::uint3>(__VA_ARGS__)
#define uint4(...) made_of<metal::uint4>(__VA_ARGS__)
#define ushort2(...) made_of<metal::ushort2>(__VA_ARGS__)
#define ushort4(...) made_of<metal::ushort4>(__VA_ARGS__)
