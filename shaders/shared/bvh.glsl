// Rays against the scene's triangles: one traversal of the four-wide SAH hierarchy that
// megaviews/scene/triangle_bvh.cpp builds, and what a hit surface looks like. VPL rays hit
// triangles, never the octree.
// bvh_data.glsl says how to include it from either language.
#ifndef MV_BVH_GLSL
#define MV_BVH_GLSL
#include "shaders/shared/bvh_data.glsl"
#include "shaders/shared/tone.glsl"

MV_BEGIN_NAMESPACE

// ---------------------------------------------------------------- textures

// The texel that coordinate i means under a wrap mode (types.glsl); size >= 1.
MV_FN int bvhWrap(int i, int size, uint mode) {
    if (mode == 1u) return clamp(i, 0, size - 1);
    int period = mode == 2u ? 2 * size : size;
    int k = i % period;
    if (k < 0) k += period;
    return k < size ? k : period - 1 - k;
}

MV_FN vec4 bvhTexelLinear(MV_BVH_PARAMS uvec4 header, int x, int y) {
    int i = bvhWrap(x, int(header.y), header.w & 3u);
    int j = bvhWrap(y, int(header.z), (header.w >> 2u) & 3u);
    uint c = bvhColourTexel(MV_BVH_ARGS header.x + uint(j) * header.y + uint(i));
    return vec4(linearFromSrgbChannel(float(c & 255u) / 255.0f),
                linearFromSrgbChannel(float((c >> 8u) & 255u) / 255.0f),
                linearFromSrgbChannel(float((c >> 16u) & 255u) / 255.0f), float(c >> 24u) / 255.0f);
}

// uv in texels, tamed so that the conversion to int is defined whatever a file says.
MV_FN vec2 bvhTexelSpace(uvec4 header, vec2 uv) {
    float x = abs(uv.x) < 1e5f ? uv.x : 0.0f;
    float y = abs(uv.y) < 1e5f ? uv.y : 0.0f;
    return vec2(x * float(header.y), y * float(header.z));
}

// Linear colour and alpha of a trace texture, bilinear unless it asks for nearest.
MV_FN vec4 sampleTraceTexture(MV_BVH_PARAMS uint textureIndex, vec2 uv) {
    uvec4 header = bvhTextureTexel(MV_BVH_ARGS textureIndex);
    vec2 p = bvhTexelSpace(header, uv);
    if ((header.w & kTraceTextureNearest) != 0u)
        return bvhTexelLinear(MV_BVH_ARGS header, int(floor(p.x)), int(floor(p.y)));
    float x = floor(p.x - 0.5f);
    float y = floor(p.y - 0.5f);
    vec4 t00 = bvhTexelLinear(MV_BVH_ARGS header, int(x), int(y));
    vec4 t10 = bvhTexelLinear(MV_BVH_ARGS header, int(x) + 1, int(y));
    vec4 t01 = bvhTexelLinear(MV_BVH_ARGS header, int(x), int(y) + 1);
    vec4 t11 = bvhTexelLinear(MV_BVH_ARGS header, int(x) + 1, int(y) + 1);
    float fx = p.x - 0.5f - x;
    float fy = p.y - 0.5f - y;
    return (t00 * (1.0f - fx) + t10 * fx) * (1.0f - fy) + (t01 * (1.0f - fx) + t11 * fx) * fy;
}

// ---------------------------------------------------------------- rays

// 2 % of a leaf of the 1024^3 grid: how far VPLs are lifted off their surface.
MV_CONST float kVplOffset = 0.02f / 1024.0f;

// How far the starts of rays are lifted, kLeastLift times a power of two (rayLift() of
// megaviews/scene/triangle_bvh.h): kVplOffset in most scenes. Less where most of a scene is small
// beside it, such as a cup on a ground of a kilometre. In a scene whose positions were packed on a
// grid (Scene::positionStep) at least a step: sheets that lay on each other, such as the inner and
// outer faces of a box, are up to a step apart there, either before the other, and rays begin above
// both.
MV_CONST float kLeastLift = kVplOffset / 16.0f;  // about 20 float steps
MV_FN float bvhLift(MV_BVH_ONLY) {
    return kLeastLift * float(1u << (bvhFlagsOf(MV_BVH_SELF) >> kBvhLiftBits));
}

// Whether rays meet what is clear and filled, as sight does: light goes through.
#ifndef MV_BVH_MEETS_FILLED
#define MV_BVH_MEETS_FILLED false
#endif
// Whether rays are sight, which takes the whole colour of a clear body where it goes in, as the
// visible surface does; light takes half of it at either face.
#ifndef MV_BVH_SIGHT
#define MV_BVH_SIGHT false
#endif
// Index of refraction inside a filled transmissive material; 0 if it is thin or lets nothing
// through.
MV_FN float bvhFilledIndex(MV_BVH_PARAMS uint material) {
    return uintBitsToFloat(bvhMaterialTexel(MV_BVH_ARGS 4u * material + 3u).x);
}

// Whether the alpha mask lets a ray through at (u, v) of a triangle: the nearest texel decides.
MV_FN bool bvhMaskedOut(MV_BVH_PARAMS uint triangle, uint material, float u, float v) {
    uvec4 base = bvhMaterialTexel(MV_BVH_ARGS 4u * material);
    uvec4 rest = bvhMaterialTexel(MV_BVH_ARGS 4u * material + 2u);
    float alpha = uintBitsToFloat(rest.z);
    uvec3 corner = bvhCorners(MV_BVH_ARGS triangle);
    float w = 1.0f - u - v;
    uint flags = bvhFlagsOf(MV_BVH_SELF);
    if ((flags & kBvhColors) != 0u) {
        alpha *= bvhColorAt(MV_BVH_ARGS corner.x).w * w + bvhColorAt(MV_BVH_ARGS corner.y).w * u +
                 bvhColorAt(MV_BVH_ARGS corner.z).w * v;
    }
    if ((flags & kBvhUvs) != 0u && rest.x != kNone) {
        vec2 uv = bvhUvAt(MV_BVH_ARGS corner.x) * w + bvhUvAt(MV_BVH_ARGS corner.y) * u +
                  bvhUvAt(MV_BVH_ARGS corner.z) * v;
        uvec4 header = bvhTextureTexel(MV_BVH_ARGS rest.x);
        vec2 p = bvhTexelSpace(header, uv);
        int i = bvhWrap(int(floor(p.x)), int(header.y), header.w & 3u);
        int j = bvhWrap(int(floor(p.y)), int(header.z), (header.w >> 2u) & 3u);
        alpha *= float(bvhColourTexel(MV_BVH_ARGS header.x + uint(j) * header.y + uint(i)) >> 24u) /
                 255.0f;
    }
    return alpha < uintBitsToFloat(base.w);
}

// Linear base colour of a triangle's material and its alpha, textures and vertex colours included.
MV_FN vec4 bvhBaseColour(MV_BVH_PARAMS uint triangle, uint material, float u, float v) {
    uvec4 base = bvhMaterialTexel(MV_BVH_ARGS 4u * material);
    uvec4 rest = bvhMaterialTexel(MV_BVH_ARGS 4u * material + 2u);
    uvec3 corner = bvhCorners(MV_BVH_ARGS triangle);
    float w = 1.0f - u - v;
    uint flags = bvhFlagsOf(MV_BVH_SELF);
    vec4 colour = vec4(bvhVec3(base), uintBitsToFloat(rest.z));
    if ((flags & kBvhColors) != 0u) {
        colour *= bvhColorAt(MV_BVH_ARGS corner.x) * w + bvhColorAt(MV_BVH_ARGS corner.y) * u +
                  bvhColorAt(MV_BVH_ARGS corner.z) * v;
    }
    if ((flags & kBvhUvs) != 0u && rest.x != kNone) {
        vec2 uv = bvhUvAt(MV_BVH_ARGS corner.x) * w + bvhUvAt(MV_BVH_ARGS corner.y) * u +
                  bvhUvAt(MV_BVH_ARGS corner.z) * v;
        colour *= sampleTraceTexture(MV_BVH_ARGS rest.x, uv);
    }
    return colour;
}

#if MV_BVH_TINTS
// The share of light, by colour, that is left behind a triangle that rays pass (TraceMaterial). A
// body has a face on either side, of which each does half of it. Approximate: light does not bend,
// and what roughness scatters goes straight on, too. leaves: the ray meets the triangle's back.
MV_FN vec3 bvhPassing(MV_BVH_PARAMS uint triangle, uint material, float u, float v, bool leaves) {
    uvec4 m1 = bvhMaterialTexel(MV_BVH_ARGS 4u * material + 1u);
    uvec4 m3 = bvhMaterialTexel(MV_BVH_ARGS 4u * material + 3u);
    vec4 colour = bvhBaseColour(MV_BVH_ARGS triangle, material, u, v);
    vec3 pass = vec3(uintBitsToFloat(m3.y), uintBitsToFloat(m3.z), uintBitsToFloat(m3.w));
    vec3 left = clamp(pass * vec3(colour.x, colour.y, colour.z), vec3(0.0f), vec3(1.0f));
    float lets = max(pass.x, max(pass.y, pass.z)) > 0.0f ? 1.0f : 0.0f;
    float covers = (m1.w & kMaterialBlends) != 0u ? clamp(colour.w, 0.0f, 1.0f) : lets;
    left = left * covers + vec3(1.0f - covers);
    if ((m1.w & kMaterialClosed) == 0u) return left;
    return MV_BVH_SIGHT ? (leaves ? vec3(1.0f) : left) : sqrt(left);
}
#endif

// Distances at which a ray meets an axis' planes of four children, at shift + byte * step.
MV_FN vec4 bvhPlanes(uint planes, float step, float shift) {
    return vec4(float(planes & 255u), float(planes >> 8u & 255u), float(planes >> 16u & 255u),
                float(planes >> 24u)) *
               step +
           shift;
}

// What each round of bvhIntersect's loops adds to a count, for who must bound them: a statement
// that ends the walk by `top = 0; group = 0u; item = kNone;`.
#ifndef MV_BVH_COUNT
#define MV_BVH_COUNT(rounds)
#endif

// A ray as boxes and triangles are asked about it.
struct BvhRay {
    vec3 origin;
    vec3 rowX, rowY, rowZ;  // of the shear that takes it to the z axis
    vec3 inverse;           // of its direction, finite
};
MV_FN BvhRay bvhRayOf(vec3 origin, vec3 direction) {
    // The largest component leads.
    vec3 size = abs(direction);
    bool zLeads = size.z >= size.x && size.z >= size.y;
    bool yLeads = !zLeads && size.y >= size.x;
    vec3 lead = zLeads ? vec3(0.0f, 0.0f, 1.0f)
                       : (yLeads ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f));
    vec3 side1 = zLeads ? vec3(1.0f, 0.0f, 0.0f)
                        : (yLeads ? vec3(0.0f, 0.0f, 1.0f) : vec3(0.0f, 1.0f, 0.0f));
    vec3 side2 = zLeads ? vec3(0.0f, 1.0f, 0.0f)
                        : (yLeads ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 0.0f, 1.0f));
    float along = dot3(direction, lead);
    BvhRay ray;
    ray.origin = origin;
    ray.rowX = side1 - lead * (dot3(direction, side1) / along);
    ray.rowY = side2 - lead * (dot3(direction, side2) / along);
    ray.rowZ = lead * (1.0f / along);
    // Zero components: a huge finite inverse keeps 0 * inverse at 0 where infinity gives NaN.
    ray.inverse = vec3(1.0f / (size.x > 1e-18f ? direction.x : 1e-18f),
                       1.0f / (size.y > 1e-18f ? direction.y : 1e-18f),
                       1.0f / (size.z > 1e-18f ? direction.z : 1e-18f));
    return ray;
}

// The nearest child of a node that a ray meets before tMax (kNone: it meets none), and a bit for
// each of the others that it meets.
MV_FN uint bvhNearestChild(MV_BVH_PARAMS uint node, BvhRay ray, float tMin, float tMax,
                           MV_OUT(uint) others) {
    uint texel = 4u * node;
    uvec4 at = bvhNodeTexel(MV_BVH_ARGS texel);
    uvec4 children = bvhNodeTexel(MV_BVH_ARGS texel + 1u);
    uvec4 low = bvhNodeTexel(MV_BVH_ARGS texel + 2u);
    uvec4 high = bvhNodeTexel(MV_BVH_ARGS texel + 3u);
    vec3 shift = (bvhVec3(at) - ray.origin) * ray.inverse;
    vec3 step =
        vec3(uintBitsToFloat(at.w), uintBitsToFloat(low.w), uintBitsToFloat(high.w)) * ray.inverse;
    uint nearX = step.x < 0.0f ? high.x : low.x;
    uint nearY = step.y < 0.0f ? high.y : low.y;
    uint nearZ = step.z < 0.0f ? high.z : low.z;
    uint farX = step.x < 0.0f ? low.x : high.x;
    uint farY = step.y < 0.0f ? low.y : high.y;
    uint farZ = step.z < 0.0f ? low.z : high.z;
    vec4 enter = max(max(bvhPlanes(nearX, step.x, shift.x), bvhPlanes(nearY, step.y, shift.y)),
                     max(bvhPlanes(nearZ, step.z, shift.z), vec4(tMin)));
    vec4 leave = min(min(bvhPlanes(farX, step.x, shift.x), bvhPlanes(farY, step.y, shift.y)),
                     min(bvhPlanes(farZ, step.z, shift.z), vec4(tMax))) *
                 1.0000005f;
    uint item = kNone;
    float tItem = kInfinity;
    uint hits = 0u;
    uint nearestBit = 0u;
    for (int k = 0; k < 4; ++k) {
        bool hit = children[k] != kNone && enter[k] <= leave[k];
        bool nearest = hit && enter[k] < tItem;
        hits |= hit ? 1u << k : 0u;
        nearestBit = nearest ? 1u << k : nearestBit;
        item = nearest ? children[k] : item;
        tItem = nearest ? enter[k] : tItem;
    }
    others = hits & ~nearestBit;
    return item;
}

// Where a ray meets a triangle's plane, if inside it: t, else kInfinity. The weights of the second
// and third corner are x and y of `weights` over z. Watertight between triangles that share corners
// [WBW13]: each corner is sheared to ray space by itself, and opposite edges give exactly opposite
// signs.
MV_FN float bvhMeetsTriangle(BvhRay ray, vec3 cornerA, vec3 cornerB, vec3 cornerC,
                             MV_OUT(vec3) weights) {
    vec3 a = cornerA - ray.origin;
    vec3 b = cornerB - ray.origin;
    vec3 c = cornerC - ray.origin;
    float ax = dot3(a, ray.rowX);
    float ay = dot3(a, ray.rowY);
    float bx = dot3(b, ray.rowX);
    float by = dot3(b, ray.rowY);
    float cx = dot3(c, ray.rowX);
    float cy = dot3(c, ray.rowY);
    MV_PRECISE float wa = cx * by - cy * bx;
    MV_PRECISE float wb = ax * cy - ay * cx;
    MV_PRECISE float wc = bx * ay - by * ax;
    bool inside =
        (wa >= 0.0f && wb >= 0.0f && wc >= 0.0f) || (wa <= 0.0f && wb <= 0.0f && wc <= 0.0f);
    MV_PRECISE float det = wa + wb + wc;
    MV_PRECISE float scaled =
        wa * dot3(a, ray.rowZ) + wb * dot3(b, ray.rowZ) + wc * dot3(c, ray.rowZ);
    weights = vec3(wb, wc, det);
    return inside && det != 0.0f ? scaled / det : kInfinity;
}

MV_FN uint bvhChild(uvec4 children, uint k) {
    return k == 0u ? children.x : k == 1u ? children.y : k == 2u ? children.z : children.w;
}
// The next child that waits becomes `item`, in bvhIntersect.
#define MV_BVH_TAKE                                                                \
    if ((group & 15u) == 0u && top > 0) {                                          \
        top -= 1;                                                                  \
        group = stack[top];                                                        \
    }                                                                              \
    if ((group & 15u) != 0u) {                                                     \
        uint first = (group & 1u) != 0u   ? 0u                                     \
                     : (group & 2u) != 0u ? 1u                                     \
                     : (group & 4u) != 0u ? 2u                                     \
                                          : 3u;                                    \
        item = bvhChild(bvhNodeTexel(MV_BVH_ARGS 4u * (group >> 4u) + 1u), first); \
        group &= group - 1u;                                                       \
    }

// The closest hit with tMin < t < tMax, or any such hit if `anyHit`: returns its slot (an index
// into the BvhTriangles) or kNone, with the barycentric weights u, v of the 2nd and 3rd corner.
// `direction` need not be unit, but not zero either. Of two hits at the same t the lower triangle
// index wins.
// passing: where kBvhTints is set, a ray that asks for any hit multiplies it by what those
// triangles leave that it passes; one that asks for the closest makes it 0 if it may have passed
// any, some of which may lie behind the hit.
MV_FN uint bvhWalk(MV_BVH_PARAMS vec3 origin, vec3 direction, float tMin, float tMax, bool anyHit,
                   MV_OUT(float) tHit, MV_OUT(float) uHit, MV_OUT(float) vHit,
                   MV_INOUT(vec3) passing) {
    tHit = tMax;
    uHit = 0.0f;
    vHit = 0.0f;
    if ((bvhFlagsOf(MV_BVH_SELF) & kBvhEmpty) != 0u) return kNone;
    BvhRay ray = bvhRayOf(origin, direction);

    // What waits: of a node, those children that the ray meets, as node << 4 and a bit for each
    // [Ylitie, Karras and Laine 2017]. One store a node: stores to an array cost most of a walk
    // where no `if` branches. The last group is at hand; a group without bits is none.
    uint stack[kBvhStack];
    int top = 0;
    uint group = 0u;
    uint slotHit = kNone;
    uint triangleHit = kNone;
    // What is at work: a child as in BvhNode; kNone ends the walk (7 is no count).
    uint item = 0u;
    // Loops that are asked at their end: at their head, lanes that run together would take a last
    // round for nothing.
    do {
        // Go down to a leaf, the nearest child first.
        if ((item & 7u) == 0u) {
            do {
                uint node = item >> 3u;
                uint others;
                item = bvhNearestChild(MV_BVH_ARGS node, ray, tMin, tHit, others);
                stack[top] = group;
                top += others != 0u && (group & 15u) != 0u ? 1 : 0;
                group = others != 0u ? node << 4u | others : group;
                if (item == kNone) {
                    MV_BVH_TAKE
                }
                MV_BVH_COUNT(1u)
            } while ((item & 7u) == 0u);
        }
        MV_BVH_COUNT(item & 7u)
        // Its triangles.
        uint slot = item >> 3u;
        uint end = item == kNone ? slot : slot + (item & 7u);
        if (slot < end) {
            do {
                uvec4 ta = bvhTriangleTexel(MV_BVH_ARGS 3u * slot);
                uvec4 tb = bvhTriangleTexel(MV_BVH_ARGS 3u * slot + 1u);
                uvec4 tc = bvhTriangleTexel(MV_BVH_ARGS 3u * slot + 2u);
                vec3 weights;
                float t = bvhMeetsTriangle(ray, bvhVec3(ta), bvhVec3(tb), bvhVec3(tc), weights);
                bool hit = t > tMin && (t < tHit || (t == tHit && ta.w < triangleHit && t < tMax));
                if (hit) {
                    float u = weights.x / weights.z;
                    float v = weights.y / weights.z;
#if MV_BVH_MASKS
                    if ((tb.w & kMaterialMask) != 0u) {
                        uint material = tb.w & ~kMaterialMask;
                        if (MV_BVH_MEETS_FILLED && bvhFilledIndex(MV_BVH_ARGS material) > 0.0f) {
                            t += bvhLift(MV_BVH_SELF);  // what lies on it is met before it
                            hit = t < tHit;
                        } else if (bvhMaskedOut(MV_BVH_ARGS ta.w, material, u, v)) {
                            hit = false;
#if MV_BVH_TINTS
                            bool tints = (bvhFlagsOf(MV_BVH_SELF) & kBvhTints) != 0u;
                            if (!anyHit && tints) passing = vec3(0.0f);
                            // Loops alone skip work where branches are masked.
                            for (tints = tints && anyHit; tints; tints = false) {
                                vec3 front =
                                    cross(bvhVec3(tb) - bvhVec3(ta), bvhVec3(tc) - bvhVec3(ta));
                                passing *= bvhPassing(MV_BVH_ARGS ta.w, material, u, v,
                                                      dot3(front, direction) > 0.0f);
                            }
#endif
                        }
                    }
#endif
                    if (hit) {
                        tHit = t;
                        uHit = u;
                        vHit = v;
                        slotHit = tc.w;
                        triangleHit = ta.w;
                    }
                }
                slot += 1u;
            } while (slot < end);
        }
        item = kNone;
        if (!(anyHit && slotHit != kNone)) {
            MV_BVH_TAKE
        }
    } while (item != kNone);
    return slotHit;
}
#undef MV_BVH_TAKE

MV_FN uint bvhIntersect(MV_BVH_PARAMS vec3 origin, vec3 direction, float tMin, float tMax,
                        bool anyHit, MV_OUT(float) tHit, MV_OUT(float) uHit, MV_OUT(float) vHit) {
    vec3 passing = vec3(1.0f);
    return bvhWalk(MV_BVH_ARGS origin, direction, tMin, tMax, anyHit, tHit, uHit, vHit, passing);
}

MV_FN bool bvhOccluded(MV_BVH_PARAMS vec3 origin, vec3 direction, float tMin, float tMax) {
    float t = 0.0f;
    float u = 0.0f;
    float v = 0.0f;
    return bvhIntersect(MV_BVH_ARGS origin, direction, tMin, tMax, true, t, u, v) != kNone;
}

// The share of light, by colour, that gets along a ray from tMin to tMax: none if anything is in
// the way, else what clear surfaces leave of it, which is all where kBvhTints is not set.
MV_FN vec3 bvhPassed(MV_BVH_PARAMS vec3 origin, vec3 direction, float tMin, float tMax) {
    float t = 0.0f;
    float u = 0.0f;
    float v = 0.0f;
    vec3 passing = vec3(1.0f);
    uint slot = bvhWalk(MV_BVH_ARGS origin, direction, tMin, tMax, true, t, u, v, passing);
    return slot != kNone ? vec3(0.0f) : passing;
}
// The closest hit, as bvhIntersect finds it, and the share of light, by colour, that gets as far.
MV_FN uint bvhIntersectTinted(MV_BVH_PARAMS vec3 origin, vec3 direction, float tMin, float tMax,
                              MV_OUT(float) tHit, MV_OUT(float) uHit, MV_OUT(float) vHit,
                              MV_OUT(vec3) passed) {
    passed = vec3(1.0f);
    uint slot = bvhWalk(MV_BVH_ARGS origin, direction, tMin, tMax, false, tHit, uHit, vHit, passed);
#if MV_BVH_TINTS
    for (bool again = passed.x == 0.0f; again; again = false) {
        passed = bvhPassed(MV_BVH_ARGS origin, direction, tMin, tHit);
    }
#endif
    return slot;
}

// ---------------------------------------------------------------- what was hit

// Normals are unit and as the file gives them: the geometric one by winding, the shading one
// turned to its side; the caller turns both to the ray (surfaces reflect on both sides).
struct BvhSurface {
    float positionX, positionY, positionZ;     // on the triangle, root-cube units
    float geometricX, geometricY, geometricZ;  // zero for a triangle without area
    float shadingX, shadingY, shadingZ;
    // Linear, texture and vertex colour included, gloss where the tables say so; 0 if unlit.
    float albedoR, albedoG, albedoB;
    float emissionR, emissionG, emissionB;  // W/(m^2 sr)
    float alpha;
    uint triangle, material, flags;  // flags: kMaterialDoubleSided, kMaterialUnlit
};

MV_FN BvhSurface bvhSurface(MV_BVH_PARAMS uint slot, float u, float v) {
    uvec4 ta = bvhTriangleTexel(MV_BVH_ARGS 3u * slot);
    uvec4 tb = bvhTriangleTexel(MV_BVH_ARGS 3u * slot + 1u);
    uvec4 tc = bvhTriangleTexel(MV_BVH_ARGS 3u * slot + 2u);
    vec3 a = bvhVec3(ta);
    vec3 b = bvhVec3(tb);
    vec3 c = bvhVec3(tc);
    float w = 1.0f - u - v;
    uint material = tb.w & ~kMaterialMask;
    uvec4 m1 = bvhMaterialTexel(MV_BVH_ARGS 4u * material + 1u);
    uvec4 m2 = bvhMaterialTexel(MV_BVH_ARGS 4u * material + 2u);
    uvec3 corner = bvhCorners(MV_BVH_ARGS ta.w);
    uint available = bvhFlagsOf(MV_BVH_SELF);

    vec3 position = a + (b - a) * u + (c - a) * v;
    vec3 geometric = normalizeOr(cross3(b - a, c - a), vec3(0.0f));
    vec3 shading = bvhNormalAt(MV_BVH_ARGS corner.x) * w + bvhNormalAt(MV_BVH_ARGS corner.y) * u +
                   bvhNormalAt(MV_BVH_ARGS corner.z) * v;
    shading = normalizeOr(shading, geometric);
    if (dot3(shading, geometric) < 0.0f) shading = -shading;

    vec4 colour = bvhBaseColour(MV_BVH_ARGS ta.w, material, u, v);
    vec3 albedo = vec3(colour.x, colour.y, colour.z);
    if ((available & kBvhGloss) != 0u) {
        albedo = albedo + (vec3(1.0f) - albedo) * uintBitsToFloat(m2.w);
    }
    vec3 emission = bvhVec3(m1);
    if ((available & kBvhEmissiveUvs) != 0u && m2.y != kNone) {
        vec2 uv = bvhEmissiveUvAt(MV_BVH_ARGS corner.x) * w +
                  bvhEmissiveUvAt(MV_BVH_ARGS corner.y) * u +
                  bvhEmissiveUvAt(MV_BVH_ARGS corner.z) * v;
        vec4 texel = sampleTraceTexture(MV_BVH_ARGS m2.y, uv);
        emission *= vec3(texel.x, texel.y, texel.z);
    }
    if ((m1.w & kMaterialUnlit) != 0u) {
        emission += albedo;
        albedo = vec3(0.0f);
    }

    BvhSurface s;
    s.positionX = position.x;
    s.positionY = position.y;
    s.positionZ = position.z;
    s.geometricX = geometric.x;
    s.geometricY = geometric.y;
    s.geometricZ = geometric.z;
    s.shadingX = shading.x;
    s.shadingY = shading.y;
    s.shadingZ = shading.z;
    s.albedoR = albedo.x;
    s.albedoG = albedo.y;
    s.albedoB = albedo.z;
    s.emissionR = emission.x;
    s.emissionG = emission.y;
    s.emissionB = emission.z;
    s.alpha = colour.w;
    s.triangle = ta.w;
    s.material = material;
    s.flags = m1.w;
    return s;
}

// Radiance that a surface emits back along a ray that meets it.
MV_FN vec3 bvhEmissionSeen(BvhSurface s, vec3 direction) {
    bool front = dot3(vec3(s.geometricX, s.geometricY, s.geometricZ), direction) < 0.0f;
    bool seen = front || (s.flags & kMaterialDoubleSided) != 0u;
    return seen ? vec3(s.emissionR, s.emissionG, s.emissionB) : vec3(0.0f);
}

MV_END_NAMESPACE
#endif
