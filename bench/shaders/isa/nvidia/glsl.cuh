// GLSL's vectors, matrices, arrays and functions in CUDA C++, for what cuda_writer.py writes. Functions are those that
// graphics drivers have an instruction for: under -use_fast_math divisions, roots and logarithms are approximations.

namespace glsl {
typedef unsigned int uint;
// A texture of floats, whose handle lies in constant memory.
typedef unsigned long long sampler2D;

template <typename T, int N> struct Array {
    T at[N];
    __forceinline__ constexpr T &operator[](int i) { return at[i]; }
    __forceinline__ constexpr const T &operator[](int i) const { return at[i]; }
    static constexpr int length() { return N; }
};

template <typename T, int N> struct Vec;
// How many components a number or a vector has, and each of them.
template <typename T> struct Size {
    static constexpr int count = 1;
};
template <typename T, int N> struct Size<Vec<T, N>> {
    static constexpr int count = N;
};
template <typename T> __forceinline__ constexpr T part_of(const T &number, int) { return number; }
template <typename T, int N> __forceinline__ constexpr T part_of(const Vec<T, N> &v, int i) { return v[i]; }

template <typename T, int N> struct Vec {
    T at[N];
    Vec() = default;
    // Components one after the other from numbers and vectors; one number alone is each of them. Where each goes is known
    // to the compiler without unrolling a loop, which it does not do for all architectures.
    template <typename... Parts> __forceinline__ constexpr explicit Vec(const Parts &...parts) : at{} {
        put<0>(parts...);
        if ((Size<Parts>::count + ...) == 1)
            for (int i = 1; i < N; ++i) at[i] = at[0];
    }
    __forceinline__ constexpr T &operator[](int i) { return at[i]; }
    __forceinline__ constexpr const T &operator[](int i) const { return at[i]; }
    static constexpr int length() { return N; }

  private:
    template <int FIRST> __forceinline__ constexpr void put() {}
    template <int FIRST, typename Part, typename... Parts>
    __forceinline__ constexpr void put(const Part &part, const Parts &...others) {
        constexpr int count = Size<Part>::count, last = FIRST + count < N ? FIRST + count : N;
        for (int i = FIRST; i < last; ++i) at[i] = T(part_of(part, i - FIRST));
        put<FIRST + count>(others...);
    }
};
typedef Vec<float, 2> vec2;
typedef Vec<float, 3> vec3;
typedef Vec<float, 4> vec4;
typedef Vec<int, 2> ivec2;
typedef Vec<int, 3> ivec3;
typedef Vec<int, 4> ivec4;
typedef Vec<uint, 2> uvec2;
typedef Vec<uint, 3> uvec3;
typedef Vec<uint, 4> uvec4;
typedef Vec<bool, 2> bvec2;
typedef Vec<bool, 3> bvec3;
typedef Vec<bool, 4> bvec4;

// A number's type where the other operand says which it is.
template <typename T> struct Of {
    typedef T type;
};
template <typename T> using Same = typename Of<T>::type;

template <int... PLACES, typename T, int N> __forceinline__ Vec<T, sizeof...(PLACES)> swizzled(const Vec<T, N> &v) {
    return Vec<T, sizeof...(PLACES)>(v[PLACES]...);
}

// v.yx = value
template <int... PLACES, typename T, int N>
__forceinline__ void assign(Vec<T, N> &v, const Vec<T, sizeof...(PLACES)> &value) {
    int at = 0;
    ((v[PLACES] = value[at++]), ...);
}

#define BINARY(MARK, RESULT)                                                                                           \
    template <typename T, int N> __forceinline__ Vec<RESULT, N> operator MARK(const Vec<T, N> &a, const Vec<T, N> &b) { \
        Vec<RESULT, N> made;                                                                                           \
        for (int i = 0; i < N; ++i) made[i] = a[i] MARK b[i];                                                          \
        return made;                                                                                                   \
    }                                                                                                                  \
    template <typename T, int N> __forceinline__ Vec<RESULT, N> operator MARK(const Vec<T, N> &a, Same<T> b) {         \
        return a MARK Vec<T, N>(b);                                                                                    \
    }                                                                                                                  \
    template <typename T, int N> __forceinline__ Vec<RESULT, N> operator MARK(Same<T> a, const Vec<T, N> &b) {         \
        return Vec<T, N>(a) MARK b;                                                                                    \
    }
#define ASSIGNING(MARK)                                                                                                \
    template <typename T, int N, typename S> __forceinline__ void operator MARK##=(Vec<T, N> &a, const S &b) {         \
        a = a MARK b;                                                                                                  \
    }
#define ARITHMETIC(MARK) BINARY(MARK, T) ASSIGNING(MARK)
ARITHMETIC(+)
ARITHMETIC(-)
ARITHMETIC(*)
ARITHMETIC(/)
ARITHMETIC(%)
ARITHMETIC(&)
ARITHMETIC(|)
ARITHMETIC(^)
ARITHMETIC(<<)
ARITHMETIC(>>)
BINARY(<, bool)
BINARY(>, bool)
BINARY(<=, bool)
BINARY(>=, bool)
BINARY(==, bool)
BINARY(!=, bool)

#define UNARY(MARK)                                                                  \
    template <typename T, int N> __forceinline__ Vec<T, N> operator MARK(Vec<T, N> v) { \
        for (int i = 0; i < N; ++i) v[i] = MARK v[i];                                \
        return v;                                                                    \
    }
UNARY(-)
UNARY(~)
UNARY(!)

template <typename T, int N> __forceinline__ Vec<T, N> chosen(const Vec<bool, N> &is, const Vec<T, N> &a, const Vec<T, N> &b) {
    Vec<T, N> made;
    for (int i = 0; i < N; ++i) made[i] = is[i] ? a[i] : b[i];
    return made;
}
// Of a truth value; both numbers are known, so nothing has to jump.
template <typename T> __forceinline__ constexpr T chosen(bool is, const T &a, const Same<T> &b) { return is ? a : b; }
template <typename T, int N> __forceinline__ Vec<T, N> chosen(bool is, const Vec<T, N> &a, const Vec<T, N> &b) {
    return chosen(Vec<bool, N>(is), a, b);
}
template <int N> __forceinline__ bool any(const Vec<bool, N> &v) {
    bool made = false;
    for (int i = 0; i < N; ++i) made |= v[i];
    return made;
}
template <int N> __forceinline__ bool all(const Vec<bool, N> &v) { return !any(!v); }

// Columns, as GLSL has them.
struct mat3 {
    vec3 at[3];
    __forceinline__ mat3(const vec3 &x, const vec3 &y, const vec3 &z) : at{x, y, z} {}
    __forceinline__ vec3 &operator[](int i) { return at[i]; }
    __forceinline__ const vec3 &operator[](int i) const { return at[i]; }
};

// Functions of numbers, then of each component. An absolute value is part of the instruction that reads it; ::fabsf would
// also flush what is denormal, which takes an instruction of its own.
__forceinline__ float abs(float x) {
    float made;
    asm("abs.f32 %0, %1;" : "=f"(made) : "f"(x));
    return made;
}
__forceinline__ int abs(int x) { return ::abs(x); }
__forceinline__ float sign(float x) { return float((x > 0.0f) - (x < 0.0f)); }
__forceinline__ float fract(float x) { return x - ::floorf(x); }
__forceinline__ float floor(float x) { return ::floorf(x); }
__forceinline__ float ceil(float x) { return ::ceilf(x); }
__forceinline__ float trunc(float x) { return ::truncf(x); }
__forceinline__ float round(float x) { return ::rintf(x); }
__forceinline__ float roundEven(float x) { return ::rintf(x); }
__forceinline__ float sqrt(float x) { return ::sqrtf(x); }
__forceinline__ float inversesqrt(float x) { return ::rsqrtf(x); }
__forceinline__ float exp2(float x) { return ::exp2f(x); }
__forceinline__ float log2(float x) { return ::log2f(x); }
__forceinline__ float exp(float x) { return ::expf(x); }
__forceinline__ float log(float x) { return ::logf(x); }
__forceinline__ float sin(float x) { return ::sinf(x); }
__forceinline__ float cos(float x) { return ::cosf(x); }
__forceinline__ float tan(float x) { return ::tanf(x); }
__forceinline__ float asin(float x) { return ::asinf(x); }
__forceinline__ float acos(float x) { return ::acosf(x); }
__forceinline__ float atan(float x) { return ::atanf(x); }
__forceinline__ float radians(float x) { return x * 0.017453292519943295f; }
__forceinline__ float degrees(float x) { return x * 57.29577951308232f; }
__forceinline__ float atan2(float y, float x) { return ::atan2f(y, x); }
__forceinline__ float pow(float x, float y) { return ::powf(x, y); }
__forceinline__ float step(float edge, float x) { return x < edge ? 0.0f : 1.0f; }
__forceinline__ float min(float a, float b) { return ::fminf(a, b); }
__forceinline__ float max(float a, float b) { return ::fmaxf(a, b); }
__forceinline__ int min(int a, int b) { return ::min(a, b); }
__forceinline__ int max(int a, int b) { return ::max(a, b); }
__forceinline__ uint min(uint a, uint b) { return ::umin(a, b); }
__forceinline__ uint max(uint a, uint b) { return ::umax(a, b); }
template <typename T> __forceinline__ T clamp(T x, Same<T> least, Same<T> most) { return min(max(x, least), most); }
__forceinline__ float mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }
__forceinline__ float fma(float a, float b, float c) { return ::fmaf(a, b, c); }
__forceinline__ float smoothstep(float a, float b, float x) {
    float t = clamp((x - a) / (b - a), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}
__forceinline__ int floatBitsToInt(float x) { return ::__float_as_int(x); }
__forceinline__ uint floatBitsToUint(float x) { return ::__float_as_uint(x); }
__forceinline__ float intBitsToFloat(int x) { return ::__int_as_float(x); }
__forceinline__ float uintBitsToFloat(uint x) { return ::__uint_as_float(x); }

#define OF_ONE(NAME)                                                                                        \
    template <typename T, int N> __forceinline__ Vec<decltype(NAME(T())), N> NAME(const Vec<T, N> &x) {     \
        Vec<decltype(NAME(T())), N> made;                                                                   \
        for (int i = 0; i < N; ++i) made[i] = NAME(x[i]);                                                   \
        return made;                                                                                        \
    }
OF_ONE(abs)
OF_ONE(sign)
OF_ONE(fract)
OF_ONE(floor)
OF_ONE(ceil)
OF_ONE(trunc)
OF_ONE(round)
OF_ONE(roundEven)
OF_ONE(sqrt)
OF_ONE(inversesqrt)
OF_ONE(exp2)
OF_ONE(log2)
OF_ONE(exp)
OF_ONE(log)
OF_ONE(sin)
OF_ONE(cos)
OF_ONE(tan)
OF_ONE(asin)
OF_ONE(acos)
OF_ONE(atan)
OF_ONE(radians)
OF_ONE(degrees)
OF_ONE(floatBitsToInt)
OF_ONE(floatBitsToUint)
OF_ONE(intBitsToFloat)
OF_ONE(uintBitsToFloat)

// Where GLSL takes a number in place of a vector, cuda_writer.py writes the vector.
#define OF_TWO(NAME)                                                                                       \
    template <typename T, int N> __forceinline__ Vec<T, N> NAME(Vec<T, N> a, const Vec<T, N> &b) {         \
        for (int i = 0; i < N; ++i) a[i] = NAME(a[i], b[i]);                                               \
        return a;                                                                                          \
    }
OF_TWO(min)
OF_TWO(max)
OF_TWO(pow)
OF_TWO(step)
OF_TWO(atan2)

#define OF_THREE(NAME)                                                                                                   \
    template <typename T, int N> __forceinline__ Vec<T, N> NAME(Vec<T, N> a, const Vec<T, N> &b, const Vec<T, N> &c) {   \
        for (int i = 0; i < N; ++i) a[i] = NAME(a[i], b[i], c[i]);                                                       \
        return a;                                                                                                        \
    }
OF_THREE(clamp)
OF_THREE(mix)
OF_THREE(fma)
OF_THREE(smoothstep)

template <int N> __forceinline__ float dot(const Vec<float, N> &a, const Vec<float, N> &b) {
    float sum = a[0] * b[0];
    for (int i = 1; i < N; ++i) sum += a[i] * b[i];
    return sum;
}
template <int N> __forceinline__ float length(const Vec<float, N> &v) { return sqrt(dot(v, v)); }
template <int N> __forceinline__ float distance(const Vec<float, N> &a, const Vec<float, N> &b) { return length(a - b); }
template <int N> __forceinline__ Vec<float, N> normalize(const Vec<float, N> &v) { return v * inversesqrt(dot(v, v)); }
template <int N> __forceinline__ Vec<float, N> reflect(const Vec<float, N> &v, const Vec<float, N> &n) {
    return v - n * (2.0f * dot(n, v));
}
__forceinline__ vec3 cross(const vec3 &a, const vec3 &b) {
    return vec3(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}
__forceinline__ vec3 operator*(const mat3 &m, const vec3 &v) { return m[0] * v[0] + m[1] * v[1] + m[2] * v[2]; }
__forceinline__ vec3 operator*(const vec3 &v, const mat3 &m) { return vec3(dot(v, m[0]), dot(v, m[1]), dot(v, m[2])); }

// A texel by its whole numbers, as a shader fetches it; CUDA's own functions take floats.
__forceinline__ vec4 texelFetch(sampler2D table, const ivec2 &place, int) {
    vec4 made;
    asm("tex.2d.v4.f32.s32 {%0, %1, %2, %3}, [%4, {%5, %6}];"
        : "=f"(made[0]), "=f"(made[1]), "=f"(made[2]), "=f"(made[3])
        : "l"(table), "r"(place[0]), "r"(place[1]));
    return made;
}
