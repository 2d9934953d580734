#pragma once
// What --save-scene and the window's Save scene write: the scene as its picture shows it, and the
// cameras that somebody may want to see it from.

#include "app/common/picture_info.h"
#include "app/common/user_state.h"
#include "megaviews/io/save_scene.h"

namespace mv {

// Lights where they stand, without one that the environment took the place of. Cameras: the
// picture's, by its name in the scene if it stands there and as "Picture" if not; then the
// bookmarks, nullptr for none, as "Bookmark 1" to 9; then the others of the scene's file. A name
// that is taken gets a number. Refers to the picture's assets.
SceneToSave sceneToSave(const PictureInfo& picture, const SceneBookmarks* bookmarks);

}  // namespace mv
