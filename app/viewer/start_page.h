#pragma once
// What the start page offers beside recent files: the built-in scenes with a picture each, and glTF
// files near the working directory. Holds textures, so only while the page is open.

#include <string>
#include <vector>

#include "renderer/gl/texture.h"
#include "ui/model.h"

namespace mv {

class StartPage {
  public:
    StartPage();
    const std::vector<ui::StartTile>& tiles() const { return tiles_; }
    const std::vector<std::string>& found() const { return found_; }

  private:
    std::vector<gl::Texture> textures_;
    std::vector<ui::StartTile> tiles_;
    std::vector<std::string> found_;
};

// glTF files in a folder and a few levels below it: of each folder the first few by name. Looks at
// so many entries at most, and follows no links to folders; what cannot be read is left out.
std::vector<std::string> scenesNear(const std::string& folder, std::size_t mostFound,
                                    std::size_t mostEntries = 4000);

}  // namespace mv
