// Results of the GPU, waited for or late.

#include "renderer/gl/read_back.h"

#include "gl_fixture.h"

namespace mv::gl {
namespace {

class ReadBackTest : public GlTest {};

TEST_F(ReadBackTest, WaitedForItIsThereAndTheWaitIsCounted) {
    const Buffer buffer = Buffer::of("numbers", std::vector<std::uint32_t>{1, 2, 3, 4});
    ReadBack back("results", Results::waited);
    EXPECT_FALSE(back.take<std::uint32_t>());
    forgetWaits();
    back.request(buffer, 4, 8);
    EXPECT_TRUE(back.requested());
    EXPECT_EQ(*back.take<std::uint32_t>(), (std::vector<std::uint32_t>{2, 3}));
    EXPECT_FALSE(back.requested());
    EXPECT_EQ(waits().size(), 1u);
    EXPECT_EQ(waits().at("fence, results"), 1u);
    buffer.read<std::uint32_t>(0, 4);
    EXPECT_EQ(waits().at("buffer, numbers"), 1u);
    expectNoGlErrors();
}

TEST_F(ReadBackTest, LateItArrivesInOrderWithoutAWait) {
    Buffer buffer("numbers", 8);
    ReadBack back("results", Results::late);
    forgetWaits();
    // More than the ring holds: the oldest goes.
    for (std::uint32_t i = 0; i < 6; ++i) {
        buffer.fill(i);
        back.request(buffer, 0, 8);
    }
    glFinish();
    EXPECT_TRUE(back.arrived());
    for (std::uint32_t i = 2; i < 6; ++i) {
        EXPECT_EQ(*back.take<std::uint32_t>(), (std::vector<std::uint32_t>{i, i}));
    }
    EXPECT_FALSE(back.take<std::uint32_t>());
    // A larger request makes a larger ring; a moved one goes on.
    const Buffer larger("more numbers", 4096);
    back.request(larger, 0, 4096);
    ReadBack moved = std::move(back);
    glFinish();
    EXPECT_EQ(moved.take<std::uint32_t>()->size(), 1024u);
    moved.request(larger, 0, 0);
    glFinish();
    EXPECT_TRUE(moved.take<std::uint32_t>()->empty());
    EXPECT_TRUE(waits().empty());
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv::gl
