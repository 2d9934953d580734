// Which pair of the traversal decides how a view sees a surface point: from the roots down, always
// to the child that holds the point or the view, until the pair is not subdivided any more. A point
// and a view have one such path, of at most one step a level of either tree [Kol19 §3.2].
//
// Like bvh_data.glsl: functions take MV_TREES_PARAMS first and are called with MV_TREES_ARGS. In
// C++ that is `const PairTrees& trees,`; in GLSL it is nothing, and nodes come from the buffer
// textures of fetch_nodes.glsl.
#ifndef MV_PAIR_PATH_GLSL
#define MV_PAIR_PATH_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/types.glsl"
#ifndef __cplusplus
#include "shaders/shared/fetch_nodes.glsl"
#endif

MV_BEGIN_NAMESPACE

#ifdef __cplusplus
struct PairTrees {
    const SceneNode* sceneNodes = nullptr;  // of the rules; the root is first
    const ViewNode* viewNodes = nullptr;
};
#define MV_TREES_PARAMS const PairTrees &trees,
#define MV_TREES_ARGS trees,
inline const SceneNode& treeSceneNode(const PairTrees& trees, uint i) {
    return trees.sceneNodes[i];
}
inline const ViewNode& treeViewNode(const PairTrees& trees, uint i) { return trees.viewNodes[i]; }
inline uint treeViewParent(const PairTrees& trees, uint i) { return parentOf(trees.viewNodes[i]); }
#else
#define MV_TREES_PARAMS
#define MV_TREES_ARGS
SceneNode treeSceneNode(uint i) { return fetchSceneNode(i); }
ViewNode treeViewNode(uint i) { return fetchViewNode(i); }
uint treeViewParent(uint i) { return fetchViewParent(i); }
#endif

// Nodes of one tree on the way to a leaf; `count` of them.
struct NodePath {
    uint nodes[kSceneLevels];
    uint count;
};

// The nodes of the scene octree that hold a surface point, root first. Boxes are tight, so the
// point may lie outside all of them by what rasterisation rounds off: the nearest one is taken, the
// first of several. Not for an empty scene.
MV_FN NodePath scenePathTo(MV_TREES_PARAMS vec3 point) {
    NodePath path;
    path.nodes[0] = 0u;
    path.count = 1u;
    SceneNode node = treeSceneNode(MV_TREES_ARGS 0u);
    while (!isLeaf(node) && path.count < kSceneLevels) {
        uint child = firstChildOf(node.children);
        uint end = child + childCountOf(node.children);
        uint nearest = child;
        float distance2 = kInfinity;
        SceneNode next = node;
        while (child < end) {
            SceneNode candidate = treeSceneNode(MV_TREES_ARGS child);
            vec3 gap =
                max(abs(minus3(point, boxCenter(candidate))) - boxHalf(candidate), vec3(0.0f));
            MV_PRECISE float gap2 = dot3(gap, gap);
            if (gap2 < distance2) {
                distance2 = gap2;
                nearest = child;
                next = candidate;
            }
            child += 1u;
        }
        node = next;
        path.nodes[path.count] = nearest;
        path.count += 1u;
    }
    return path;
}

// The nodes of the view hierarchy from a leaf up, the leaf first.
MV_FN NodePath viewPathFrom(MV_TREES_PARAMS uint leaf) {
    NodePath path;
    path.count = 0u;
    uint node = leaf;
    while (node != kNone && path.count < kTreeLevels) {
        path.nodes[path.count] = node;
        path.count += 1u;
        node = treeViewParent(MV_TREES_ARGS node);
    }
    return path;
}

// Where a path of pairs ends.
struct PairEnd {
    uint sceneNode, viewNode;
    uint decision;    // kPair*: culled, skipped, or rendered in one way or another
    uint viewCount;   // views of the view node: those that share the decision
    uint sceneLevel;  // of the scene node
};
MV_FN bool isRendered(PairEnd end) { return pairRendered(end.decision); }

MV_FN PairEnd pairEnd(MV_TREES_PARAMS NodePath scene, NodePath views, uint rules, float pairRes) {
    PairEnd end;
    uint s = 0u;
    uint v = views.count - 1u;  // the root: paths of views begin at the leaf
    uint decision = kPairSplitView;
    bool open = true;
    while (open) {
        SceneNode sceneNode = treeSceneNode(MV_TREES_ARGS scene.nodes[s]);
        ViewNode viewNode = treeViewNode(MV_TREES_ARGS views.nodes[v]);
        decision = decidePair(sceneNode, viewNode, rules, pairRes);
        end.viewCount = viewNode.viewCount;
        end.sceneLevel = sceneNode.level;
        open = decision == kPairSplitScene || decision == kPairSplitView;
        if (decision == kPairSplitScene) s += 1u;
        if (decision == kPairSplitView) v -= 1u;
    }
    end.sceneNode = scene.nodes[s];
    end.viewNode = views.nodes[v];
    end.decision = decision;
    return end;
}

MV_END_NAMESPACE
#endif
