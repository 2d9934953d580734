#include "app/bench/stress_case_groups.h"

namespace mv::stress {

Settings usual() {
    Settings s;
    s.resolution = {64, 48};
    s.views.vpls = kUsualViews;
    s.scene.octreeDepth = s.views.octreeDepth = 8;
    return s;
}

Input finished(World world, Settings settings) {
    return {world.finish(settings.scene.octreeDepth), std::nullopt, settings};
}

glm::dvec3 inRoom(std::uint32_t seed, std::uint32_t index) {
    return glm::dvec3(0.3, 0.2, 0.3) +
           glm::dvec3(randomPoint(seed, index)) * glm::dvec3(7.4, 3.6, 5.4);
}

const std::vector<Case>& cases() {
    static const std::vector<Case> made = [] {
        std::vector<Case> all;
        all.push_back({"room", "the benign case", [] { return finished(litRoom()); }, 1});
        addScaleCases(all);
        addViewCases(all);
        addTriangleCases(all);
        addLightCases(all);
        addCameraCases(all);
        addResolutionCases(all);
        return all;
    }();
    return made;
}

}  // namespace mv::stress
