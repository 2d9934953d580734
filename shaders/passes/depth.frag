// Depth only; a masked material lets light through where it is cut out.
#include "shaders/shared/bindings.glsl"
#ifdef MV_MASK
uniform float baseAlpha;
uniform float alphaCutoff;
#ifdef MV_COLORS
in float alphaAt;
#endif
#ifdef MV_BASE_TEXTURE
in vec2 uvAt;
layout(binding = kUnitBaseTexture) uniform sampler2D baseTexture;
#endif
#endif

void main() {
#ifdef MV_MASK
    float alpha = baseAlpha;
#ifdef MV_COLORS
    alpha *= alphaAt;
#endif
#ifdef MV_BASE_TEXTURE
    alpha *= texture(baseTexture, uvAt).a;
#endif
    if (alpha < alphaCutoff) discard;
#endif
}
