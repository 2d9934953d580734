#pragma once
// What makes a view important: what it gives the surfaces that a camera sees
// (shaders/shared/importance.glsl).

#include <cstdint>
#include <vector>

#include "megaviews/scene/triangle_bvh.h"
#include "megaviews/views/frame_camera.h"
#include "shaders/shared/importance.glsl"

namespace mv {

// From where views are important.
struct ImportanceCamera {
    FrameCamera camera;
    float aspect = 1;  // width / height
    bool operator==(const ImportanceCamera&) const = default;
};

// Surfaces that the camera sees through points spread evenly over its picture, by rays: the
// picture's size does not matter. Fewer than `count` where rays miss; empty if all do.
std::vector<ImportancePoint> importancePoints(const TriangleBvh& bvh,
                                              const ImportanceCamera& camera, std::uint32_t seed,
                                              int count = 64);

// What makes a view important: the points that the camera sees, and how much of what it would give
// them gets there, by places around it of which that was asked.
struct Importance {
    std::vector<ImportancePoint> points;
    std::vector<ImportancePlace> places;   // sorted by key; none: all of it
    float distance = kImportanceDistance;  // of importanceTerm()
    // What a view gives the mean point, W / root-cube unit^2, without constants.
    float of(const View& view) const;
};
Importance importanceOf(std::vector<ImportancePoint> points);  // without places

// Some of a pilot's views, which lie where light falls, and places that the points themselves see:
// what lights them from near, however little light the pilot found there.
std::vector<ImportancePlace> placesAround(const TriangleBvh& bvh, const Importance& importance,
                                          const std::vector<View>& pilot);

}  // namespace mv
