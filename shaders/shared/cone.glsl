// Cones of directions and boxes of points as both octrees merge them, bottom-up and conservatively,
// without acos or any other function that is not correctly rounded everywhere [Kol19 fig. 3].
#ifndef MV_CONE_GLSL
#define MV_CONE_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// Every merge widens the cone by this angle, ten times what rounding can lose.
MV_CONST float kConeWideningRad = 2.0e-6f;
// Shorter than this share of the weights, a sum of unit vectors has no direction worth using.
MV_CONST float kConeCancelled = 1.0e-3f;

// Sums over the views of a leaf run over blocks of this many, aligned in the sorted views, where
// the leaf holds all of one, and over single views elsewhere; so GPU and CPU add in the same order.
MV_CONST uint kViewBlock = 64u;

// Grows the cone (axis, theta) so that it holds the cone (otherAxis, otherTheta); angles are
// (cos, sin) pairs in [0, pi/2). Axes are unit vectors. False, theta then being useless, if the
// result would reach a hemisphere. Start from (1, 0) and end with coneFinish.
MV_FN bool coneInclude(vec3 axis, vec3 otherAxis, float otherCos, float otherSin,
                       MV_INOUT(float) cosTheta, MV_INOUT(float) sinTheta) {
    // Both parts of the angle between the axes: each alone is blind where it is flat.
    MV_PRECISE float c = dot3(axis, otherAxis);
    MV_PRECISE float s = length3(cross3(axis, otherAxis));
    MV_PRECISE float cosSum = c * otherCos - s * otherSin;
    MV_PRECISE float sinSum = s * otherCos + c * otherSin;
    if (!(cosSum > 0.0f) || sinSum < 0.0f) return false;  // the sum is below 3 pi / 2
    // sin(sum - theta) > 0: the other cone sticks out.
    MV_PRECISE float excess = sinSum * cosTheta - cosSum * sinTheta;
    if (excess > 0.0f) {
        cosTheta = cosSum;
        sinTheta = sinSum;
    }
    return true;
}

// Widens by kConeWideningRad and brings (cos, sin) back to unit length. False beyond a hemisphere.
MV_FN bool coneFinish(MV_INOUT(float) cosTheta, MV_INOUT(float) sinTheta) {
    MV_PRECISE float c = cosTheta - kConeWideningRad * sinTheta;
    MV_PRECISE float s = sinTheta + kConeWideningRad * cosTheta;
    MV_PRECISE float l2 = c * c + s * s;
    MV_PRECISE float l = sqrt(l2);
    if (!(c > 0.0f)) return false;
    cosTheta = c / l;
    sinTheta = s / l;
    return true;
}

// Axis of a cone from the weighted sum of unit vectors; false if they cancel, and any axis.
MV_FN bool coneAxis(vec3 sum, float weight, MV_OUT(vec3) axis) {
    axis = normalizeOr(sum, vec3(0.0f, 0.0f, 1.0f));
    MV_PRECISE float least = kConeCancelled * weight;
    if (length3(sum) > least) return true;
    axis = vec3(0.0f, 0.0f, 1.0f);
    return false;
}

// Centre of an interval and its half extent, rounded up unless it is exactly zero, so that
// |x - centre| <= half for every x of the interval, and in real numbers too.
MV_FN float intervalCenter(float lo, float hi) {
    MV_PRECISE float c = 0.5f * (lo + hi);
    return c;
}
MV_FN float intervalHalf(float lo, float hi, float center) {
    MV_PRECISE float above = hi - center;
    MV_PRECISE float below = center - lo;
    float h = max(above, below);
    if (!(h > 0.0f)) return 0.0f;
    return uintBitsToFloat(floatBitsToUint(h) + 1u);
}

MV_END_NAMESPACE
#endif
