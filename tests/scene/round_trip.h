#pragma once
// A scene that is saved and loaded again, for the tests of saveScene(). What differs is a failure.

#include <filesystem>

#include "megaviews/io/save_scene.h"
#include "scene/gltf_builder.h"

namespace mv::testing {

Bytes readBytes(const std::filesystem::path& file);

// What the loader warns of, and what is not glTF by the letter, is a failure, too.
Scene roundTrip(const SceneToSave& saved);

void expectSameGeometry(const Scene& a, const Scene& b);

// Geometry, looks, lights and cameras.
void expectRoundTrip(const SceneToSave& saved);

}  // namespace mv::testing
