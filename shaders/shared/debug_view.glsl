// The values of mv::DebugView, for the shaders that compose and show a picture. Macros, so that
// each view is compiled alone.
#ifndef MV_DEBUG_VIEW_GLSL
#define MV_DEBUG_VIEW_GLSL
#include "shaders/shared/language.glsl"

#define MV_VIEW_FINAL 0
#define MV_VIEW_DIRECT 1
#define MV_VIEW_INDIRECT 2
#define MV_VIEW_UNFILTERED 3
#define MV_VIEW_NORMALS 4
#define MV_VIEW_ALBEDO 5
#define MV_VIEW_DEPTH 6
#define MV_VIEW_CANDIDATES 7
#define MV_VIEW_NAN 8
#define MV_VIEW_SHARING 9
#define MV_VIEW_SHARED 10
#define MV_VIEW_UNDECIDED 11
#endif
