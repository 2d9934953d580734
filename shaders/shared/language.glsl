// The common subset of GLSL 4.50 and C++20. A header in this folder is written once and included
// by compute shaders and by megaviews/ alike; this file hides the few places where the two
// languages differ. In C++ every name lives in namespace mv and GLM supplies the vector types.
//
// Rules for such headers: free functions only, no vec3 members in structs, no implicit
// int/float/bool conversions, float literals written 1.0f, scalar results by return and further
// results by MV_OUT parameters, no array parameters. Arithmetic on which a decision depends is
// held in MV_PRECISE variables and uses only + - * / sqrt, so that both sides give the same bits.
#ifndef MV_LANGUAGE_GLSL
#define MV_LANGUAGE_GLSL

#ifdef __cplusplus
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>

#define MV_BEGIN_NAMESPACE namespace mv {
#define MV_END_NAMESPACE }
#define MV_FN inline
#define MV_CONST inline constexpr
#define MV_OUT(type) type&
#define MV_INOUT(type) type&
#define MV_PRECISE

namespace mv {
using uint = std::uint32_t;
using glm::ivec2;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using std::sqrt;  // glm::sqrt and std::sqrt agree; this one is correctly rounded by IEEE 754

inline uint floatBitsToUint(float x) {
    uint u;
    std::memcpy(&u, &x, sizeof u);
    return u;
}
inline float uintBitsToFloat(uint u) {
    float x;
    std::memcpy(&x, &u, sizeof x);
    return x;
}
using glm::abs;
using glm::ceil;
using glm::clamp;
using glm::exp2;
using glm::floor;
using glm::fract;
using glm::max;
using glm::min;
using glm::mix;
using std::acos;
using std::atan2;
using std::cos;
using std::sin;
}  // namespace mv
#else
#define MV_BEGIN_NAMESPACE
#define MV_END_NAMESPACE
#define MV_FN
#define MV_CONST const
#define MV_OUT(type) out type
#define MV_INOUT(type) inout type
#define MV_PRECISE precise
#define atan2(y, x) atan(y, x)
#endif

MV_BEGIN_NAMESPACE

MV_CONST float kPi = 3.14159265358979f;
MV_CONST float kInfinity = 3.402823466e38f;  // largest finite float: stands for "no bound"
MV_CONST uint kNone = 0xFFFFFFFFu;           // an absent index, map, or empty texel

// Products and sums in one fixed order: unlike dot() and length() of either language, these give
// the same bits in C++ and on any GPU with IEEE multiplication and addition.
MV_FN float dot3(vec3 a, vec3 b) {
    MV_PRECISE float r = a.x * b.x + a.y * b.y + a.z * b.z;
    return r;
}
MV_FN vec3 cross3(vec3 a, vec3 b) {
    MV_PRECISE float x = a.y * b.z - a.z * b.y;
    MV_PRECISE float y = a.z * b.x - a.x * b.z;
    MV_PRECISE float z = a.x * b.y - a.y * b.x;
    return vec3(x, y, z);
}
MV_FN float length3(vec3 a) {
    MV_PRECISE float r = sqrt(dot3(a, a));
    return r;
}
// The unit vector along a, or `fallback` (itself a unit vector) where a is shorter than 1e-20.
MV_FN vec3 normalizeOr(vec3 a, vec3 fallback) {
    MV_PRECISE float l = length3(a);
    if (!(l > 1e-20f)) return fallback;
    MV_PRECISE float x = a.x / l;
    MV_PRECISE float y = a.y / l;
    MV_PRECISE float z = a.z / l;
    return vec3(x, y, z);
}

MV_END_NAMESPACE

// Finds the first index of low .. high - 1 for which the condition on `middle` holds, which then
// holds for all that follow: low becomes it, or high if there is none.
#define MV_FIND_FIRST(low, high, middle, condition) \
    while (low < high) {                            \
        uint middle = (low + high) >> 1u;           \
        if (condition)                              \
            high = middle;                          \
        else                                        \
            low = middle + 1u;                      \
    }

#endif
