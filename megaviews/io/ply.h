#pragma once
// Views as PLY point clouds, so that a set can be replayed or made elsewhere: --save-views and
// --views. One vertex a view, `x y z nx ny nz red green blue`: position in the file's world units,
// unit normal (zero = omnidirectional), flux in linear RGB watts.

#include <filesystem>
#include <string>
#include <vector>

#include "megaviews/scene/scene.h"
#include "megaviews/views/view_set.h"

namespace mv {

// Binary little-endian, positions double, everything else float. Living views only, in slot order;
// slots themselves are not stored. There are no normal columns if every view is omnidirectional.
// Throws Error(ExitCode::output).
void saveViews(const std::filesystem::path& file, const ViewSet& views, const RootCube& root);

// ASCII or binary little-endian, LF or CRLF. Vertices come first; their properties are float,
// double or uchar, in any order, others than those above skipped, and what follows the vertices is
// not read. Slots count up from 0 and a view with a normal is a VPL of bounce 1. Normals are
// normalised. `red green blue` of type uchar are divided by 255: other tools' colours become fluxes
// up to 1 W. Views belong into the scene's root cube, whose margin round the scene is 1/64 of its
// edge: up to 1e-3 of the edge outside are clamped and said in `warnings`, farther is an error.
// Throws Error(ExitCode::input), naming file and place. Nothing is allocated on the word of a
// header that the file's size does not bear out.
ViewSet loadViews(const std::filesystem::path& file, const RootCube& root,
                  std::vector<std::string>* warnings = nullptr);

// The same from a file's bytes; `name` is what messages call it.
ViewSet parseViews(std::string bytes, const std::string& name, const RootCube& root,
                   std::vector<std::string>* warnings = nullptr);

// How many views a file may hold: fewer than the gather's sums of power can tell apart.
inline constexpr std::uint64_t kMaxViewsInFile = (1ull << 23) - 1;

}  // namespace mv
