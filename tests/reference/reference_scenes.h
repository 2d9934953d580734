#pragma once
// What the tests of the references share: receivers, thread counts, cancelled work.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

#include "megaviews/core/error.h"
#include "megaviews/gather/gather.h"
#include "megaviews/references/exact_gather.h"
#include "megaviews/references/path_tracer.h"
#include "views/rooms.h"

namespace mv::testing {

// Points in free space, normals in every direction: a receiver needs no surface, and without one
// nearby the light of single views stays bounded.
inline std::vector<Receiver> receiversInside(std::uint32_t seed, std::size_t count, float margin) {
    std::vector<Receiver> out;
    for (uint i = 0; i < count; ++i) {
        const vec4 a = random4(seed, i, 0, 200), b = random4(seed, i, 0, 201);
        const vec3 p = vec3(0.5f) + (1 - 2 * margin) * (vec3(a.x, a.y, a.z) - 0.5f);
        out.push_back({p, sphereDirection(b.x, b.y)});
    }
    return out;
}

inline IrradianceImage traced(const Lit& lit, const std::vector<Receiver>& receivers,
                              PathTraceOptions options) {
    const EmbreeScene embree(lit.bvh);
    IrradianceImage image;
    pathTrace(embree, lit.emitters, receivers, static_cast<int>(receivers.size()), 1, options,
              image);
    EXPECT_TRUE(image.done());
    return image;
}

inline bool sameBytes(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

class Threads {
  public:
    explicit Threads(std::size_t count)
        : control_(tbb::global_control::max_allowed_parallelism, count) {}

  private:
    tbb::global_control control_;
};

// work(image, progress) gives the same bytes for one and two threads and when it is cancelled half
// way and goes on; `rows` is the height of its image.
template <typename Work>
IrradianceImage expectRepeatable(const Work& work, int rows) {
    IrradianceImage one, two, resumed;
    {
        const Threads threads(1);
        work(one, Progress{});
    }
    {
        const Threads threads(2);
        work(two, Progress{});
    }
    EXPECT_TRUE(sameBytes(one.mean, two.mean));
    EXPECT_TRUE(sameBytes(one.variance, two.variance));
    const Progress cancel = [](std::string_view, float share) {
        if (share >= 0.5f) throw Cancelled();
    };
    EXPECT_THROW(work(resumed, cancel), Cancelled);
    EXPECT_FALSE(resumed.done());
    EXPECT_EQ(resumed.rowsDone, (rows + 1) / 2);
    EXPECT_FALSE(sameBytes(one.mean, resumed.mean));
    // What is done is not done again.
    resumed.mean[0] += glm::vec3(1);
    work(resumed, Progress{});
    EXPECT_EQ(resumed.mean[0], one.mean[0] + glm::vec3(1));
    resumed.mean[0] = one.mean[0];
    EXPECT_TRUE(resumed.done());
    EXPECT_TRUE(sameBytes(one.mean, resumed.mean));
    EXPECT_TRUE(sameBytes(one.variance, resumed.variance));
    return one;
}

}  // namespace mv::testing
