#pragma once
// An array as a whole.

#include "megaviews/io/npy.h"

namespace mv {

template <typename T>
void writeNpy(const std::filesystem::path& path, const std::vector<std::uint64_t>& shape,
              std::span<const T> elements) {
    NpyWriter<T> writer(path, shape);
    writer.write(elements);
    writer.commit();
}

}  // namespace mv
