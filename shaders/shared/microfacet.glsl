// The gloss of a surface: GGX microfacets [Walter et al. 2007] with Smith's height-correlated
// masking [Heitz 2014] and Schlick's Fresnel term, as glTF 2.0 asks (appendix B). Gloss is narrow,
// and followed by rays, below a roughness of kRoughGloss, and from kRoughestGloss on broad: lit as
// matt surfaces are, each direction by its own share (BroadGloss). Between, it is partly either.
// A clear coat is narrow gloss on top, whatever is below is then broad.
// Approximate: the layer takes from the matt surface below what it reflects itself, whatever the
// direction of the light; light that bounces between facets is given back evenly.
#ifndef MV_MICROFACET_GLSL
#define MV_MICROFACET_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/sampling.glsl"

MV_BEGIN_NAMESPACE

MV_CONST float kRoughGloss = 0.5f;
MV_CONST float kRoughestGloss = 0.7f;
MV_CONST float kSpecularOfGlass = 0.04f;  // at normal incidence, index 1.5
MV_CONST uint kGlossDraw = 22u;           // `dimension` of random4
MV_CONST uint kGlossLampDraw = 23u;       // of what rays to lamps are drawn by
// Smoother gloss meets lamps by its own rays alone.
MV_CONST float kLampGloss = 0.15f;

// The GGX distribution's alpha; not quite a mirror, so that a point light has a highlight.
MV_FN float ggxAlpha(float roughness) { return max(roughness * roughness, 1e-3f); }
// The alpha of rays that follow the gloss. A mirror's go where they must: the tails of even the
// narrowest lobe leave stray pixels beside what is bright.
MV_FN float ggxRayAlpha(float roughness) { return max(roughness * roughness, 1e-6f); }

// Share of a surface's gloss that is followed by rays.
MV_FN float glossShare(float roughness) {
    float x = clamp((kRoughestGloss - roughness) / (kRoughestGloss - kRoughGloss), 0.0f, 1.0f);
    return x * x * (3.0f - 2.0f * x);
}

// atGrazing: the share that is reflected there; 1 but where a layer is dimmed as a whole
// [KHR_materials_specular]. cosine: between the light and the facet it meets.
MV_FN vec3 schlickFresnel(vec3 atNormal, float atGrazing, float cosine) {
    float m = 1.0f - clamp(cosine, 0.0f, 1.0f);
    float m2 = m * m;
    return atNormal + (vec3(atGrazing) - atNormal) * (m2 * m2 * m);
}

// Share of the facets that one direction sees, by Smith; cosine > 0.
MV_FN float ggxSeen(float cosine, float alpha) {
    float c2 = cosine * cosine;
    return 2.0f * cosine / (cosine + sqrt(alpha * alpha * (1.0f - c2) + c2));
}
// The same that two directions see of those that the first does.
MV_FN float ggxSeenToo(float cosView, float cosLight, float alpha) {
    float a2 = alpha * alpha;
    float v = cosLight * sqrt(a2 + (1.0f - a2) * cosView * cosView);
    float l = cosView * sqrt(a2 + (1.0f - a2) * cosLight * cosLight);
    float both = 2.0f * cosView * cosLight / max(v + l, 1e-20f);
    return both / max(ggxSeen(cosView, alpha), 1e-20f);
}

// Density of facets that are turned to `facet`, 1/sr.
MV_FN float ggxFacets(float alpha, vec3 normal, vec3 facet) {
    float c = dot3(normal, facet);
    float a2 = alpha * alpha;
    // 1 - (1 - a2) c^2, without the cancellation of a nearly perfect mirror.
    vec3 off = cross3(normal, facet);
    float d = dot3(off, off) + a2 * c * c;
    return a2 / (kPi * max(d * d, 1e-20f));
}

// The gloss's BRDF, 1/sr. All directions unit, away from the surface; 0 below it.
MV_FN vec3 ggxBrdf(vec3 atNormal, float atGrazing, float alpha, vec3 normal, vec3 toEye,
                   vec3 toLight) {
    float cosView = dot3(normal, toEye);
    float cosLight = dot3(normal, toLight);
    if (cosView <= 0.0f || cosLight <= 0.0f) return vec3(0.0f);
    vec3 facet = normalizeOr(toEye + toLight, normal);
    float density = ggxFacets(alpha, normal, facet);
    float seen = ggxSeen(cosView, alpha) * ggxSeenToo(cosView, cosLight, alpha);
    return schlickFresnel(atNormal, atGrazing, dot3(toLight, facet)) *
           (density * seen / (4.0f * cosView * cosLight));
}

// The direction of a ray that leaves along the gloss, drawn as the eye sees the facets [Heitz 2018,
// JCGT 7(4)], and its weight: light that comes along it times the weight is what is reflected.
// toEye on the normal's side of the surface.
MV_FN vec3 ggxReflection(vec3 atNormal, float atGrazing, float alpha, vec3 normal, vec3 toEye,
                         float u, float v, MV_OUT(vec3) weight) {
    vec3 x = aroundAxis(normal, 1.0f, 0.0f, 0.0f);
    vec3 y = aroundAxis(normal, 0.0f, 1.0f, 0.0f);
    vec3 eye = vec3(dot3(toEye, x), dot3(toEye, y), max(dot3(toEye, normal), 1e-4f));
    // Stretched, the facets are those of a hemisphere.
    vec3 stretched = normalizeOr(vec3(eye.x * alpha, eye.y * alpha, eye.z), vec3(0.0f, 0.0f, 1.0f));
    vec3 across = normalizeOr(vec3(-stretched.y, stretched.x, 0.0f), vec3(1.0f, 0.0f, 0.0f));
    vec3 up = cross3(stretched, across);
    vec2 cs = cosSin2Pi(v);
    float r = sqrt(u);
    float a = r * cs.x;
    float s = 0.5f * (1.0f + stretched.z);
    float b = (1.0f - s) * sqrt(max(1.0f - a * a, 0.0f)) + s * r * cs.y;
    vec3 facet = across * a + up * b + stretched * sqrt(max(1.0f - a * a - b * b, 0.0f));
    facet = normalizeOr(vec3(facet.x * alpha, facet.y * alpha, max(facet.z, 1e-6f)),
                        vec3(0.0f, 0.0f, 1.0f));
    float cosine = dot3(eye, facet);
    vec3 leaves = facet * (2.0f * cosine) - eye;
    weight = vec3(0.0f);
    if (leaves.z > 0.0f) {
        weight = schlickFresnel(atNormal, atGrazing, cosine) * ggxSeenToo(eye.z, leaves.z, alpha);
    }
    return aroundAxis(normal, leaves.x, leaves.y, leaves.z);
}

// The probability density, 1/sr, with which ggxReflection() takes a direction.
MV_FN float ggxReflectionDensity(float alpha, vec3 normal, vec3 toEye, vec3 toLight) {
    float cosView = max(dot3(normal, toEye), 1e-4f);
    vec3 facet = normalizeOr(toEye + toLight, normal);
    return ggxFacets(alpha, normal, facet) * ggxSeen(cosView, alpha) / (4.0f * cosView);
}

// Share of the light that the gloss reflects towards the eye where light comes from everywhere
// alike, off one facet. Rational functions fitted to sums over the lobe: within 0.02 where the
// cosine is above 0.05.
MV_FN vec3 glossAlbedo(vec3 atNormal, float atGrazing, float roughness, float cosView) {
    float r = roughness;
    float q = cosView / (cosView + r * r + 1e-6f);
    // Hidden by other facets, and by Fresnel's term beyond what is reflected at normal incidence.
    float lost = r * (((-0.9189f * r + 2.0729f) * r - 1.0421f) +
                      ((4.6891f * r - 8.5717f) * r + 5.3363f) * q +
                      ((-1.2123f * r + 4.9966f) * r - 4.2879f) * q * q);
    float m = 1.0f - cosView;
    float m2 = m * m;
    float edge =
        m2 * m2 * m *
        (((0.6033f * r - 1.4145f) * r + 0.8464f) + ((3.1491f * r - 3.635f) * r + 0.391f) * q +
         ((-3.8455f * r + 5.4975f) * r - 0.2436f) * q * q);
    lost = clamp(lost, 0.0f, 1.0f);
    edge = clamp(edge, 0.0f, 1.0f - lost);
    return atNormal * (1.0f - lost - edge) + vec3(atGrazing * edge);
}

// What light that bounces between facets adds to that of one facet, as a factor [Turquin 2019,
// Practical multiple scattering compensation for microfacet models].
MV_FN vec3 glossCompensation(vec3 atNormal, float roughness, float cosView) {
    float once = glossAlbedo(vec3(1.0f), 1.0f, roughness, cosView).x;
    return vec3(1.0f) + atNormal * (1.0f / once - 1.0f);
}

// Share of the light from everywhere alike that the gloss reflects, those bounces included.
MV_FN vec3 glossReflectance(vec3 atNormal, float atGrazing, float roughness, float cosView) {
    return min(glossAlbedo(atNormal, atGrazing, roughness, cosView) *
                   glossCompensation(atNormal, roughness, cosView),
               vec3(1.0f));
}

// Share of the light that passes a clear coat towards the eye. strength: of the coat, 0 .. 1.
MV_FN float underCoat(float strength, float roughness, float cosView) {
    float cosine = clamp(cosView, 0.0f, 1.0f);
    return 1.0f - strength * glossReflectance(vec3(kSpecularOfGlass), 1.0f, roughness, cosine).x;
}

// ---------------------------------------------------------------- broad gloss

// The part that broad gloss has in the light that a surface's albedo reflects towards the eye.
struct BroadGloss {
    float eyeX, eyeY, eyeZ;     // unit, towards the eye
    float partR, partG, partB;  // of albedo, 0 .. 1
    float atNormal, atGrazing, alpha;
    float scale;  // times ggxBrdf reflects all light that comes evenly
};

// leastRoughness: of its lobe. part: of the gloss that is broad, with all else that `albedo` has as
// a factor. Approximate: the edge of a coloured gloss is of one colour.
MV_FN BroadGloss broadGloss(vec3 atNormal, float atGrazing, float roughness, float leastRoughness,
                            float part, vec3 albedo, vec3 normal, vec3 toEye) {
    float cosEye = clamp(dot3(normal, toEye), 0.0f, 1.0f);
    vec3 reflected = glossReflectance(atNormal, atGrazing, roughness, cosEye) * part;
    BroadGloss g;
    g.eyeX = toEye.x;
    g.eyeY = toEye.y;
    g.eyeZ = toEye.z;
    g.partR = clamp(reflected.x / max(albedo.x, 1e-6f), 0.0f, 1.0f);
    g.partG = clamp(reflected.y / max(albedo.y, 1e-6f), 0.0f, 1.0f);
    g.partB = clamp(reflected.z / max(albedo.z, 1e-6f), 0.0f, 1.0f);
    g.atNormal = max(atNormal.x, max(atNormal.y, atNormal.z));
    g.atGrazing = atGrazing;
    float lobe = max(roughness, leastRoughness);
    g.alpha = ggxAlpha(lobe);
    g.scale = 1.0f / max(glossAlbedo(vec3(g.atNormal), atGrazing, lobe, cosEye).x, 1e-6f);
    return g;
}

// The same of a surface as GBuffer's textures hold it. coat: 0 where it has none.
MV_FN BroadGloss broadGlossOf(vec4 albedo, vec4 gloss, float atGrazing, vec4 coat,
                              float leastRoughness, vec3 normal, vec3 toEye) {
    float part = 1.0f - glossShare(gloss.w);
    float strength = length3(vec3(coat));
    if (strength > 0.0f) part = underCoat(strength, coat.w, dot3(vec3(coat), toEye) / strength);
    return broadGloss(vec3(gloss), atGrazing, gloss.w, leastRoughness, part * albedo.w,
                      vec3(albedo), normal, toEye);
}

// What light from a direction gives such a surface, relative to a matt one of the same albedo; 1
// in the mean over all directions by their cosine.
MV_FN vec3 broadGlossWeight(BroadGloss g, vec3 normal, vec3 toLight) {
    vec3 part = vec3(g.partR, g.partG, g.partB);
    if (!(max(part.x, max(part.y, part.z)) > 0.0f)) return vec3(1.0f);
    vec3 toEye = vec3(g.eyeX, g.eyeY, g.eyeZ);
    float lobe =
        kPi * g.scale * ggxBrdf(vec3(g.atNormal), g.atGrazing, g.alpha, normal, toEye, toLight).x;
    return vec3(1.0f) + part * (lobe - 1.0f);
}

MV_END_NAMESPACE
#endif
