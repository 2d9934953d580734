#pragma once
// The shaders that sum up a pixel's samples (shaders/passes/gather_sum.glsl): which program answers
// for a method and its maps, all that it reads, and in which parts it runs.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "renderer/passes/gather_cull_pass.h"
#include "renderer/passes/gather_pass.h"

namespace mv {

// A call of GatherPass.
struct GatherCall : GatherInputs {
    gl::Profiler* profiler = nullptr;  // of a picture, which may be watched
    Resting resting = {};
};

// alone: pixels of upsample.comp's list; again: of second_look.comp's. The last two write down one
// pixel's samples. verdicts: what one slice of the maps knows of the samples that `gather` or
// `samples` then sum.
enum class GatherShader { gather, verdicts, measure, alone, again, samples, upsampleSamples };

// What a dispatch of the gather covers: all pixels, or for their samples those around one.
struct GatherArea {
    glm::ivec2 origin{0}, size{0};
    std::uint32_t firstTile = 0, tiles = 0;  // of kTileEdge pixels
};

class GatherSum {
  public:
    GatherSum();
    // Written by GatherPass::prepare().
    GatherViews views;
    GatherLists lists;
    // At a scale above 1, at the resolution of the gather: light and candidates before the filter.
    gl::Texture coarse, coarseCandidates;
    gl::Buffer askedCounts;  // two uints: samples that could ask GatherOptions::sample, that did

    // The programs, with all that they read but what the caller gives: images and render targets.
    gl::Program& bindMeasure(const GatherCall& in);
    gl::Program& bindAlone(const GatherCall& in);
    // samples: how many of each pixel; every number draws other ones.
    gl::Program& bindAgain(const GatherCall& in, std::uint32_t samples);
    gl::Program& bindUpsampleSamples(const GatherCall& in);
    // What shaders/passes/upsample.glsl reads.
    void setUpsample(gl::Program& program, const GatherCall& in, const gl::Texture& filteredCoarse);
    gl::Program& bindGather(GatherShader shader, const GatherCall& in);
    // Before bindGather(), where maps are there slice by slice: makes each and asks it. Throws
    // Error(ExitCode::impossible) if there are more answers than can be kept.
    void askSlices(const GatherCall& in, const GatherArea& area);
    // Draws views for the area's tiles, then runs the program of bindGather() over it.
    void runGather(gl::Program& program, GatherShader shader, const GatherCall& in,
                   const GatherArea& area);
    GatherArea wholePicture() const;
    GatherArea groupAround(glm::ivec2 pixel) const;  // what one work group serves

    // Calls run() for parts of the samples that any pixel may have, with the uniforms that name the
    // part: as many at once as the loops allow. A part after the first is added to the first
    // `targets` render targets.
    void inParts(gl::Program& program, GatherShader shader, const GatherCall& in, int targets,
                 const std::function<void()>& run);
    std::uint64_t bytes() const;

  private:
    using Part = std::function<void(std::uint32_t first, std::uint32_t count)>;
    gl::Program& program(GatherShader shader, const GatherCall& in);
    void bindLists(gl::Program& program, const GatherCall& in);
    void bindVisibility(gl::Program& program, GatherShader shader, const GatherCall& in);
    gl::Program& bindSum(GatherShader shader, const GatherCall& in);
    // Binds the surfaces of the gather's pixels, and says where their gloss lies in the G-buffer.
    void bindSurfaces(gl::Program& p, const GatherCall& in);
    void inParts(gl::Program& program, GatherShader shader, const GatherCall& in,
                 std::uint32_t most, std::uint32_t mostAtOnce, int targets, const Part& run);
    std::uint32_t drawTilesAcross() const;

    std::map<std::pair<GatherShader, gl::Defines>, gl::Program> programs_;
    gl::Program draw_;
    gl::TexelBuffer<glm::uvec2> draws_;  // GatherDraw
    gl::Buffer roundsOverflow_;
    gl::Buffer verdicts_;  // of askSlices(), 16 a word
};

}  // namespace mv
