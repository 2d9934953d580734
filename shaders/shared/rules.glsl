// The rules of pairs: those printed in [Kol19 §3.2], and what is corrected of them, a bit for each
// correction. Any of them can be taken alone (`--rules`); names stand in
// megaviews/settings/settings_rows_method.cpp in the order of the bits.
#ifndef MV_RULES_GLSL
#define MV_RULES_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// Scene nodes are drawn where their surface is, at its centroid, and not at their box's centre.
MV_CONST uint kRuleCentroid = 1u;
// Nodes of both trees are tight boxes, culled as boxes, and not voxels, culled as balls.
MV_CONST uint kRuleBoxes = 2u;
// A view node of one view is a leaf at any level, and not at the last alone.
MV_CONST uint kRuleLoneViews = 4u;
// The size that is compared bounds that from every view of the node, whichever node is larger, and
// not only about that from views straight ahead [fig. 6].
MV_CONST uint kRuleBound = 8u;
// The larger node of a pair is subdivided, by radius, and not the one of the coarser level, which
// of voxels is the same.
MV_CONST uint kRuleRadius = 16u;
// A pair is drawn below two texels, and not below one.
MV_CONST uint kRuleTwoTexels = 32u;
// What is drawn is a surface element, at its depth along each texel's ray and also close around a
// view, and not a point.
MV_CONST uint kRuleSurfaces = 64u;
// The shadow test follows a texel's footprint, or leaves samples undecided, and does not subtract
// a constant bias.
MV_CONST uint kRuleFootprint = 128u;

MV_CONST uint kRuleCount = 8u;
MV_CONST uint kPublishedRules = 0u;
MV_CONST uint kCorrectedRules = (1u << kRuleCount) - 1u;

MV_FN bool hasRule(uint rules, uint rule) { return (rules & rule) != 0u; }

// The tables of nodes that rules ask for, 0 .. 3 of either tree.
MV_CONST uint kNodeTables = 4u;
MV_FN uint sceneTable(uint rules) { return rules & (kRuleCentroid | kRuleBoxes); }
MV_FN uint viewTable(uint rules) { return (rules & (kRuleBoxes | kRuleLoneViews)) >> 1u; }

MV_END_NAMESPACE
#endif
