// References through FrameRenderer: the same receivers, composition and exposure as the GPU's.

#include <cmath>

#include "gpu/frame_fixture.h"
#include "megaviews/reference/exact_gather.h"

namespace mv {
namespace {

class FrameReference : public test::FrameTest {
  protected:
    // Answers with the exact gather and counts how often it was asked.
    ReferenceSource gather(bool visibility) {
        return [this, visibility](const ReferenceRequest& request) {
            ++asked;
            const TriangleBvh bvh = TriangleBvh::build(scene());
            const EmbreeScene embree(bvh);
            IrradianceImage image;
            exactGather(embree, request.views, request.receivers, request.settings.width,
                        request.settings.height, {.visibility = visibility}, image);
            return image.mean;
        };
    }
    int asked = 0;
};

TEST_F(FrameReference, WithoutVisibilityIsTheFullSumOfTheGpu) {
    settings.method = Method::none;
    settings.gatherSamples = 0;
    settings.filter = false;
    render();
    const std::vector<float> gpu = radiance();
    settings.method = Method::exact;
    renderer->setReferences(gather(false));
    render();
    const std::vector<float> open = radiance();
    renderer->setReferences(gather(true));
    startAfresh();
    renderer->setReferences(gather(true));
    render();
    const std::vector<float> exact = radiance();
    double worst = 0, sum = 0, darker = 0;
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        worst = std::max(worst, std::abs(double{open[i]} - double{gpu[i]}) / (gpu[i] + 1e-3));
        sum += double{gpu[i]};
        darker += double{open[i]} - double{exact[i]};
        ASSERT_LE(exact[i], open[i]);
    }
    EXPECT_GT(sum, 0);
    EXPECT_LT(worst, 2e-3);  // packed normals and fluxes
    EXPECT_GT(darker, 0.002 * sum);
}

TEST_F(FrameReference, IsMadeOnceForAllThatShowsIt) {
    renderer->setReferences(gather(true));
    settings.compare = Method::exact;
    settings.accumulate = 3;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(render().accumulatedFrames, i + 1);
    settings.difference = Difference::absolute;
    settings.exposureEv = 2;
    settings.view = DebugView::indirect;
    render();
    EXPECT_EQ(asked, 1);
    const PixelValues pixel = renderer->readPixel(37, 10);
    ASSERT_TRUE(pixel.surface);
    EXPECT_EQ(pixel.sides[1].unfiltered.x * pixel.albedo.x / kPi, pixel.sides[1].indirect.x);
    EXPECT_TRUE(renderer->readSamples(37, 10, 1).empty());
    settings.seed = 5;
    render();
    EXPECT_EQ(asked, 2);
}

TEST_F(FrameReference, NeedsSomebodyToMakeIt) {
    for (const Method method : {Method::exact, Method::pathtraced}) {
        settings.method = method;
        try {
            render();
            FAIL() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.code, ExitCode::usage);
            EXPECT_NE(std::string(error.what()).find("--headless"), std::string::npos);
        }
    }
    settings.method = Method::none;
    render();
    EXPECT_GT(radiance()[0] + 1, 0);
}

}  // namespace
}  // namespace mv
