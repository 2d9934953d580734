#include "renderer/passes/traversal_job.h"

#include "renderer/gl/context.h"
#include "shaders/shared/paraboloid.glsl"

namespace mv {

void TexelBuffer::ensure(const std::string& label, GLenum format, std::uint64_t bytes) {
    if (buffer && buffer.bytes() >= bytes) return;
    texels = {};
    buffer.ensure(label, bytes);
    texels = gl::TextureBuffer(label, format, buffer);
}

std::uint64_t TraversalJob::mapBytes() const {
    return 4ull * mapTexels(static_cast<uint>(options.viewRes));
}
std::uint64_t TraversalJob::mipBytes() const {
    return mips ? 4ull * mipTexels(static_cast<uint>(options.viewRes)) : 0;
}

gl::Defines TraversalJob::defines() const {
    const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
    return {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)},
            {"MV_PUBLISHED", flag(options.rules == Rules::published)},
            {"MV_VIEW_RES", std::to_string(options.viewRes)},
            {"MV_HOLE_FILL", flag(options.holeFill)},
            {"MV_FUSE", flag(fuse)},
            {"MV_MIPS", flag(mips)},
            {"MV_COUNT", flag(options.countPairs)}};
}

std::uint64_t TraversalBuffers::bytes() const {
    return mips.bytes() + work[0].buffer.bytes() + work[1].buffer.bytes();
}

void TraversalBuffers::bind(const TraversalJob& job) const {
    job.scene.nodesTexels.bind(0);
    job.views.nodesTexels.bind(1);
    counters.bindStorage(0);
    status.bindStorage(1);
    job.out.texels.bindStorage(5);
    if (job.mips) mips.bindStorage(7);
}

gl::Program& ProgramCache::get(const std::string& file, const gl::Defines& defines) {
    std::string key = file;
    for (const auto& [name, value] : defines) key += " " + name + "=" + value;
    gl::Program& program = programs_[key];
    if (!program) program = gl::Program(file, {"passes/" + file}, defines);
    return program;
}

}  // namespace mv
