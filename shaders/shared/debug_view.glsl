// The values of mv::DebugView, for the shaders that compose and show a picture.
#ifndef MV_DEBUG_VIEW_GLSL
#define MV_DEBUG_VIEW_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE
MV_CONST int kViewFinal = 0;
MV_CONST int kViewDirect = 1;
MV_CONST int kViewIndirect = 2;
MV_CONST int kViewUnfiltered = 3;
MV_CONST int kViewNormals = 4;
MV_CONST int kViewAlbedo = 5;
MV_CONST int kViewDepth = 6;
MV_CONST int kViewCandidates = 7;
MV_CONST int kViewNan = 8;
MV_END_NAMESPACE
#endif
