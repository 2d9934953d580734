#pragma once
// Arrays as NumPy's .npy files (format 1.0 written; 1.0, 2.0 and 3.0 read): float32, float64 and
// uint32, little-endian, C order. Serves --save-maps and whatever else a script should read.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "megaviews/core/output_file.h"

namespace mv {

// Writes piece by piece, so that an array need not exist as a whole. T: float, double or uint32.
template <typename T>
class NpyWriter {
  public:
    NpyWriter(const std::filesystem::path& path, const std::vector<std::uint64_t>& shape);
    void write(std::span<const T> elements);
    // As OutputFile's; both assert that exactly the shape's elements were written.
    void close();
    void commit();

  private:
    OutputFile file_;
    std::uint64_t left_ = 0;
};

template <typename T>
struct NpyArray {
    std::vector<std::uint64_t> shape;
    std::vector<T> elements;
};

// Throws Error(ExitCode::input) with file and reason if it is not an array of T.
template <typename T>
NpyArray<T> readNpy(const std::filesystem::path& path);

}  // namespace mv
