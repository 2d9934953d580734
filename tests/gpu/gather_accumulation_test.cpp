// The running mean of sets of samples against the sets themselves, averaged on the CPU.

#include "gpu/gather_fixture.h"

namespace mv {
namespace {

using test::GatherGpu;

TEST_F(GatherGpu, RunningMeanIsTheMeanOfTheSets) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(900, 11), {});
    const GpuViewHierarchy gpuTree = upload(tree);
    const GBuffer gbuffer = room->gbuffer(53, 29);
    gl::Profiler profiler;
    GatherOptions options = test::plainOptions();
    options.samples = 4;
    gl::Texture mean;
    std::vector<double> sum;
    for (int n = 1; n <= 7; ++n) {
        options.accumulationIndex = static_cast<std::uint32_t>(n - 1);
        GatherResult set;
        test::gatherOnce(pass(), gbuffer, room->scene.root, gpuTree, {}, options, profiler, set);
        const auto values = set.irradiance.readFloats(4);
        sum.resize(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) sum[i] += double{values[i]};
        if (n == 1) {
            mean = std::move(set.irradiance);
        } else {
            pass().accumulate(set.irradiance, n, profiler, mean);
        }
        const auto got = mean.readFloats(4);
        for (std::size_t i = 0; i < got.size(); ++i) {
            if (i % 4 == 3) continue;  // the last set's variance
            const double want = sum[i] / n;
            ASSERT_NEAR(double{got[i]}, want, 1e-5 * want + 1e-12) << "set " << n << " value " << i;
        }
    }
    EXPECT_EQ(gl::reportedErrors(), 0u);
}

}  // namespace
}  // namespace mv
