#pragma once
// A headless context for each test of a suite; without one the test is skipped with the reason.

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <memory>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"

namespace mv {

class GlTest : public ::testing::Test {
  protected:
    void SetUp() override {
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
        } catch (const Error& e) {
            GTEST_SKIP() << e.what();
        }
    }
    // Errors the driver reported since the context was made.
    static void expectNoGlErrors() {
        glFinish();
        EXPECT_EQ(gl::reportedErrors(), 0u);
    }

  private:
    std::unique_ptr<gl::HeadlessContext> context_;
};

}  // namespace mv
