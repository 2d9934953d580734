// A pixel of the G-buffer without a surface, which shows a radiance.
layout(location = 0) out vec4 outPosition;
layout(location = 1) out vec4 outNormalDepth;
layout(location = 2) out vec4 outAlbedo;
layout(location = 3) out vec4 outEmission;
layout(location = 4) out vec4 outPlane;
layout(location = 5) out vec4 outGloss;  // where the G-buffer has it
layout(location = 6) out vec4 outClear;  // so, too
layout(location = 7) out vec4 outCoat;   // so, too

void writeNoSurface(vec3 radiance) {
    outPosition = vec4(0.0);
    outNormalDepth = vec4(0.0);
    outAlbedo = vec4(0.0);
    outEmission = vec4(radiance, 1.0);
    outPlane = vec4(0.0);
    outGloss = vec4(0.0);
    outClear = vec4(0.0);
    outCoat = vec4(0.0);
}
