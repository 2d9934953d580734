#include "app/bench/stress_case_groups.h"

namespace mv::stress {

Settings usual() {
    Settings s;
    s.width = 64;
    s.height = 48;
    s.vpls = kUsualViews;
    s.sceneDepth = s.viewDepth = 8;
    return s;
}

Input finished(World world, Settings settings) {
    return {world.finish(settings.sceneDepth), std::nullopt, settings};
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
