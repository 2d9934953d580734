#pragma once
// Which materials cover bodies, that a ray meets on two sides, and which sheets: a window pane may
// be modelled as either.

#include <vector>

#include "megaviews/scene/scene.h"

namespace mv {

// By material: whether most of the area that has it, of those that tint light (Material::tints()),
// belongs to parts whose triangles hang together and close: vectors of their areas add up to less
// than a tenth of the areas. False for all others, and where there is nothing of it.
std::vector<bool> closedMaterials(const Scene& scene);

}  // namespace mv
