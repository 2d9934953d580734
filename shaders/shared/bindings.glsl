// Where shaders find what the host binds: texture units, storage blocks, images and uniform blocks.
// Each resource has one number in all programs. Storage blocks of passes that never meet in one
// program share numbers, since OpenGL promises few of them; texture units do not.
#ifndef MV_BINDINGS_GLSL
#define MV_BINDINGS_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// ---------------------------------------------------------------- texture units

// Trees, views and maps (renderer/passes/gpu_data.h).
MV_CONST uint kUnitSceneNodes = 0u;
MV_CONST uint kUnitMarchNodes = 3u;
MV_CONST uint kUnitViews = 4u;  // by slot
MV_CONST uint kUnitSortedViews = 5u;
MV_CONST uint kUnitViewKeys = 6u;
MV_CONST uint kUnitViewNodes = 7u;
MV_CONST uint kUnitMapOfNode = 8u;
MV_CONST uint kUnitLeafOfView = 9u;
MV_CONST uint kUnitMaps = 10u;

// Rays: ten units, in the order of bvh_data.glsl, then emitters and the points of surfaces.
MV_CONST uint kUnitBvh = 11u;
MV_CONST uint kUnitLights = 21u;
MV_CONST uint kUnitEmissive = 22u;
MV_CONST uint kUnitGuide = 23u;
MV_CONST uint kUnitSurfacePoints = 24u;

// Points made each frame.
MV_CONST uint kUnitClusters = 1u;
MV_CONST uint kUnitGroupLevels = 2u;
MV_CONST uint kUnitFirstPoints = 45u;

// Traversal.
MV_CONST uint kUnitParentLists = 25u;
MV_CONST uint kUnitOwnLists = 26u;
MV_CONST uint kUnitParentMaps = 27u;
MV_CONST uint kUnitPairQueue = 28u;
MV_CONST uint kUnitLargePairs = 29u;

// Prefix sums, sorting, view hierarchy.
MV_CONST uint kUnitCounts = 30u;
MV_CONST uint kUnitSumBases = 31u;
MV_CONST uint kUnitSortPairs = 32u;
MV_CONST uint kUnitSortAlive = 33u;
MV_CONST uint kUnitBinBegins = 34u;
MV_CONST uint kUnitViewLevels = 35u;
MV_CONST uint kUnitNodeBegins = 36u;
MV_CONST uint kUnitNodeStarts = 37u;
MV_CONST uint kUnitNodeBounds = 38u;
MV_CONST uint kUnitViewBlocks = 39u;

// Gather.
MV_CONST uint kUnitPowerPrefix = 40u;
MV_CONST uint kUnitViewSearch = 41u;
MV_CONST uint kUnitGatherRecords = 42u;
MV_CONST uint kUnitTiles = 43u;
MV_CONST uint kUnitDraws = 44u;
MV_CONST uint kUnitReceiverLists = 46u;
MV_CONST uint kUnitRuns = 47u;
MV_CONST uint kUnitRunWords = 48u;
MV_CONST uint kUnitRunSearch = 49u;
MV_CONST uint kUnitSurfaces = 50u;
MV_CONST uint kUnitFilterSource = 52u;
MV_CONST uint kUnitFilteredCoarse = 53u;
MV_CONST uint kUnitUnfilteredCoarse = 54u;
MV_CONST uint kUnitCandidatesCoarse = 55u;
MV_CONST uint kUnitSampleSet = 56u;

// G-buffer, direct light, picture.
MV_CONST uint kUnitPosition = 57u;
MV_CONST uint kUnitNormal = 58u;
MV_CONST uint kUnitAlbedo = 59u;
MV_CONST uint kUnitEmission = 60u;
MV_CONST uint kUnitBaseTexture = 61u;
MV_CONST uint kUnitEmissiveTexture = 62u;
MV_CONST uint kUnitDirect = 64u;
MV_CONST uint kUnitIrradiance = 65u;
MV_CONST uint kUnitCandidates = 66u;
MV_CONST uint kUnitRadiance = 67u;
MV_CONST uint kUnitLeft = 68u;
MV_CONST uint kUnitRight = 69u;
MV_CONST uint kUnitDifferences = 70u;
MV_CONST uint kUnitDisplay = 71u;
MV_CONST uint kUnitOverlay = 72u;
MV_CONST uint kUnitSurfaceDepth = 73u;
MV_CONST uint kUnitLines = 74u;
MV_CONST uint kUnitImportancePoints = 76u;
MV_CONST uint kUnitClampDistances = 77u;
MV_CONST uint kUnitPlane = 78u;
MV_CONST uint kUnitPlanes = 79u;
MV_CONST uint kUnitRememberedSurfaces = 80u;
MV_CONST uint kUnitRememberedLight = 81u;
MV_CONST uint kUnitRememberedSamples = 82u;
MV_CONST uint kUnitSky = 83u;

// Kept cuts.
MV_CONST uint kUnitSceneParents = 51u;
MV_CONST uint kUnitCutNodes = 63u;
MV_CONST uint kUnitCutSteps = 75u;
MV_CONST uint kUnitCutChains = 84u;
MV_CONST uint kUnitCutLastMerged = 85u;

// Gloss.
MV_CONST uint kUnitMetalTexture = 86u;
MV_CONST uint kUnitNormalTexture = 87u;
MV_CONST uint kUnitGloss = 88u;
MV_CONST uint kUnitReflected = 89u;
MV_CONST uint kUnitReflectionWeight = 90u;
MV_CONST uint kUnitClear = 91u;
MV_CONST uint kUnitCoat = 92u;
MV_CONST uint kUnitCoatTexture = 93u;
MV_CONST uint kUnitCoatNormalTexture = kUnitCoat;  // while the coat's normals are being made

// Sky by parallel views.
MV_CONST uint kUnitSkyViews = 94u;
MV_CONST uint kUnitSkyMaps = 95u;

// ---------------------------------------------------------------- storage blocks

// Maps and traversal.
MV_CONST uint kBlockPairCounters = 0u;
MV_CONST uint kBlockStatus = 1u;
MV_CONST uint kBlockPairQueue = 2u;
MV_CONST uint kBlockLists = 2u;
MV_CONST uint kBlockPassRanges = 2u;
MV_CONST uint kBlockListHeads = 3u;
MV_CONST uint kBlockLargePairs = 3u;
MV_CONST uint kBlockMaps = 4u;
MV_CONST uint kBlockWorkMaps = 5u;
MV_CONST uint kBlockMips = 6u;
MV_CONST uint kBlockPackedMaps = 6u;
MV_CONST uint kBlockResumed = 7u;
MV_CONST uint kBlockSuspended = 8u;
MV_CONST uint kBlockCommand = 8u;  // bound while those of the queue stay

// Kept cuts; beside counters, status and command, and maps where they are drawn.
MV_CONST uint kBlockSceneParents = 2u;
MV_CONST uint kBlockOldCutViews = 2u;
MV_CONST uint kBlockOldCutNodes = 2u;
MV_CONST uint kBlockCutLastMerged = 6u;
MV_CONST uint kBlockCutNodes = 3u;
MV_CONST uint kBlockNewCutViews = 4u;
MV_CONST uint kBlockCutMerged = 4u;
MV_CONST uint kBlockCutSteps = 5u;
MV_CONST uint kBlockCutPending = 7u;
MV_CONST uint kBlockCutChains = 7u;

// Points made each frame.
MV_CONST uint kBlockGroupLevels = 0u;
MV_CONST uint kBlockPointCounts = 0u;
MV_CONST uint kBlockPoints = 0u;
MV_CONST uint kBlockClusters = 1u;

// Views, prefix sums, sorting, view hierarchy.
MV_CONST uint kBlockViews = 0u;
MV_CONST uint kBlockImportance = 1u;
MV_CONST uint kBlockImportanceSums = 2u;
MV_CONST uint kBlockImportanceTotals = 3u;
MV_CONST uint kBlockImportancePlaces = 4u;
MV_CONST uint kBlockSums = 0u;
MV_CONST uint kBlockBinCounts = 0u;
MV_CONST uint kBlockSortPairs = 0u;
MV_CONST uint kBlockSortAlive = 1u;
MV_CONST uint kBlockSortedViews = 0u;
MV_CONST uint kBlockViewKeys = 1u;
MV_CONST uint kBlockViewLevels = 0u;
MV_CONST uint kBlockNodeCounts = 0u;
MV_CONST uint kBlockNodeStarts = 0u;
MV_CONST uint kBlockLevelTable = 0u;
MV_CONST uint kBlockViewBlocks = 0u;
MV_CONST uint kBlockViewNodes = 0u;
MV_CONST uint kBlockMapOfNode = 1u;
MV_CONST uint kBlockNodeBounds = 2u;
MV_CONST uint kBlockLeafOfView = 3u;

// Gather; its samples meet the maps and the sorted views.
MV_CONST uint kBlockBlockPower = 0u;
MV_CONST uint kBlockBlockUnits = 1u;
MV_CONST uint kBlockPowerPrefix = 2u;
MV_CONST uint kBlockViewSearch = 0u;
MV_CONST uint kBlockClampDistances = 0u;
MV_CONST uint kBlockGatherRecords = 0u;
MV_CONST uint kBlockTiles = 0u;
MV_CONST uint kBlockDraws = 5u;
MV_CONST uint kBlockPlaces = 1u;
MV_CONST uint kBlockRuns = 0u;
MV_CONST uint kBlockReceiverLists = 1u;
MV_CONST uint kBlockRunSearch = 0u;
MV_CONST uint kBlockGatheredSamples = 1u;
MV_CONST uint kBlockRoundsOverflow = 2u;
MV_CONST uint kBlockAskedCounts = 3u;
MV_CONST uint kBlockVerdicts = 4u;
MV_CONST uint kBlockAlonePixels = 6u;

// Pictures.
MV_CONST uint kBlockBadCounts = 0u;
MV_CONST uint kBlockHistogram = 0u;

MV_CONST uint kStorageBlocks = 9u;  // that a compute shader may have

// ---------------------------------------------------------------- images and uniform blocks

MV_CONST uint kImageSurfaces = 0u;
MV_CONST uint kImagePlanes = 1u;
MV_CONST uint kImageIrradiance = 0u;
MV_CONST uint kImageCandidates = 1u;
MV_CONST uint kImageUnfiltered = 1u;
MV_CONST uint kImageFound = 1u;
MV_CONST uint kImageUpsampledCandidates = 2u;
MV_CONST uint kImageMean = 0u;
MV_CONST uint kImageDisplayMean = 1u;
MV_CONST uint kUniformVplSetup = 0u;

MV_END_NAMESPACE
#endif
