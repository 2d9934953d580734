#include "renderer/methods/megaviews/traversal_job.h"

#include "megaviews/methods/megaviews/pairs.h"
#include "renderer/gl/context.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/pair.glsl"

namespace mv {

std::uint64_t TraversalJob::mapBytes() const {
    return 4 * mapWords(MapStore{static_cast<uint>(options.maps.resolution)}, 1);
}
std::uint64_t TraversalJob::finalBytes() const { return mapBytes() / (out.packed ? 2 : 1); }
std::uint64_t TraversalJob::mipBytes() const {
    return mips ? 4 * mipWords(MapStore{static_cast<uint>(options.maps.resolution)}, 1) : 0;
}

float TraversalJob::pairResolution() const { return mv::pairResolution(options); }

gl::Defines TraversalJob::defines() const {
    const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
    return {{"MV_ONE_VECTOR", flag(gl::limits().groupIsOneVector)},
            {"MV_RULES", std::to_string(options.rules)},
            {"MV_MAP_RES", std::to_string(options.maps.resolution) + "u"},
            {"MV_HOLE_FILL", flag(options.pairs.holeFill)},
            {"MV_FUSE", flag(fuse)},
            {"MV_MIPS", flag(mips)},
            {"MV_COUNT", options.countLevels ? "2" : flag(options.countPairs)}};
}

std::uint64_t TraversalBuffers::mapBytes() const {
    return mips.bytes() + work[0].bytes() + work[1].bytes() + unpacked.bytes();
}

void TraversalBuffers::bind(const TraversalJob& job, const PassRange& range) const {
    job.scene.nodes.bindTexels(kUnitSceneNodes);
    job.views.nodes.bindTexels(kUnitViewNodes);
    job.views.mapOfNode.bindTexels(kUnitMapOfNode);
    counters.bindStorage(kBlockPairCounters);
    status.bindStorage(kBlockStatus);
    const std::uint64_t bytes = (range.maps.y - range.maps.x) * job.mapBytes();
    if (job.out.packed) {
        unpacked.bindStorage(kBlockMaps, 0, bytes);
    } else {
        job.out.texels.bindStorage(kBlockMaps, job.sliced ? 0 : range.maps.x * job.mapBytes(),
                                   bytes);
    }
    if (job.mips) mips.bindStorage(kBlockMips);
}

void dispatchCounted(gl::Program& program, std::uint32_t statusIndex, std::uint64_t capacity,
                     int perGroup, TraversalBuffers& buffers, ProgramCache& programs) {
    gl::Program& prepare = programs.get("megaviews/prepare_dispatch.comp");
    prepare.set("statusIndex", statusIndex);
    prepare.set("capacity", static_cast<std::uint32_t>(capacity));
    prepare.set("perGroup", static_cast<std::uint32_t>(perGroup));
    buffers.command.ensure("traversal command", 16);
    buffers.command.bindStorage(kBlockCommand);
    prepare.dispatchInvocations(1);
    program.dispatchIndirect(buffers.command, 0);
}

void splatLarge(const TraversalJob& job, const PassRange& range,
                const gl::TexelBuffer<glm::uvec2>& large, TraversalBuffers& buffers,
                ProgramCache& programs) {
    gl::Program& program = programs.get("megaviews/splat_large.comp", job.defines());
    program.set("firstMap", range.maps.x);
    program.set("statusIndex", kStatusLarge);
    program.set("largeCapacity", static_cast<std::uint32_t>(large.size()));
    large.bindTexels(kUnitLargePairs);
    dispatchCounted(program, kStatusLarge, large.size(), 1, buffers, programs);
}

gl::Program& ProgramCache::get(const std::string& file, const gl::Defines& defines) {
    std::string key = file;
    for (const auto& [name, value] : defines) key += " " + name + "=" + value;
    gl::Program& program = programs_[key];
    if (!program) program = gl::Program(file, {"methods/" + file}, defines);
    return program;
}

}  // namespace mv
