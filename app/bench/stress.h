#pragma once
// Hard numerical cases, each through the whole line on CPU and GPU: scene, octree, views, view
// octree, traversal, maps, gather, picture (docs/numerics.md). A case passes if its pictures are
// finite, if visibility is wrong for no more light than a stated multiple of what it is wrong for
// in the benign case, if GPU and CPU agree, and, where scaling or moving a scene must change
// nothing, if its picture is that of the case it was made from.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/common/scene_assets.h"
#include "megaviews/settings/settings.h"
#include "megaviews/views/view_set.h"
#include "renderer/frame_renderer.h"

namespace mv::stress {

struct Input {
    std::unique_ptr<SceneAssets> assets;  // with a camera
    std::optional<ViewSet> views;         // instead of VPLs
    Settings settings;                    // of the picture; method and rules are the runner's
};

// The picture must be that of another case times `gain`: summed absolute difference, as a share of
// the sum. 0 = to the bit.
struct Equality {
    std::string other;
    double gain = 1;
    double tolerance = 0;
};

struct Case {
    std::string name;
    std::string why;  // it is hard; one sentence
    std::function<Input()> make;
    double factor = 1.5;  // error at most this many times the benign case's, setup by setup
    std::optional<Equality> sameAs = {};
    // How far the light of a picture may be from that of rays where the sky is parallel views.
    double skyGap = 0.005;
};

// Method, rules and traversal that each case runs with.
struct Setup {
    Method method;
    uint rules;
    Traversal traversal;
};
std::string nameOf(const Setup& setup);
const std::vector<Setup>& setups();

// In the order of the documentation; the first is the benign one.
const std::vector<Case>& cases();

struct Result {
    std::string name;
    std::uint64_t views = 0;      // alive
    std::uint64_t badPixels = 0;  // NaN or infinite, over all pictures
    // Light that visibility gets wrong, summed over the picture, as a share of all light that would
    // arrive if nothing hid anything: MegaViews with corrected rules.
    double error = 0;
    double leaked = 0;                         // the part of it that arrives and should not
    double errorFactor = 0;                    // times the benign case's: the worst of all setups
    std::string worstSetup;                    // which has it
    double allowedFactor = 0;                  // infinite: not bounded
    std::uint64_t pairsGpu = 0, pairsCpu = 0;  // processed, over all setups
    std::uint64_t texels = 0, texelsDiffering = 0;
    std::uint64_t viewsDiffering = 0;  // GPU's traced views from the CPU's
    std::uint64_t nodesDiffering = 0;  // GPU's view nodes from the CPU's, over all setups
    double pictureGap = 0;             // GPU's full sum from the CPU's, worst setup; as `error`
    std::optional<double> apart;       // from the case it must equal
    double ms = 0;
    std::vector<std::string> failures;  // empty: passed
};

// Needs a current context. Keeps the renderer, and what later cases are compared with.
class Runner {
  public:
    Result run(const Case& oneCase);

  private:
    struct Measured;
    class Measurement;
    const Measured& measured(const Case& oneCase);
    Measured measure(const Case& oneCase);

    FrameRenderer renderer_;
    std::map<std::string, std::shared_ptr<const Measured>> kept_;
};

std::string tableHeader();
std::string tableRow(const Result& result);

// `megaviews-bench stress` and `selftest`, which runs the quick ones: arguments without the
// command. Return the exit code.
int stressCommand(const std::vector<std::string>& arguments);
int selfTestCommand(const std::vector<std::string>& arguments);

}  // namespace mv::stress
