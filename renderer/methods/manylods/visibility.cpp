// ManyLoDs [HREB11 §3.1]: the pairs of MegaViews over a flat view hierarchy, so that each view
// finds a cut through the scene of its own.

#include "renderer/methods/megaviews/visibility.h"

namespace mv {

template <>
std::unique_ptr<Visibility> makeVisibility<Method::manylods>(gl::Results results) {
    return std::make_unique<ManyViewVisibility>(results);
}

}  // namespace mv
