#pragma once
// The image that the settings name as environment, read when they first do.

#include <memory>
#include <string>

#include "megaviews/views/sky.h"

namespace mv {

// Floating point is linear radiance in W/(m^2 sr), whole numbers are sRGB. What is negative or not
// a number counts as black, and is logged; what is infinite counts as 65504. Throws
// Error(ExitCode::input) naming the file.
EnvironmentImage readEnvironment(const std::string& file);

// Whether a file that is dropped on the window lights the scene: by its name.
bool isEnvironmentFile(const std::string& file);

class EnvironmentSlot {
  public:
    // Null where the settings name no image. Throws as readEnvironment, and asks again next time.
    std::shared_ptr<const EnvironmentImage> of(const EnvironmentSettings& settings);
    // Reads an image anew, whose file may have changed. Throws likewise; the old one then stays.
    void readAgain();

  private:
    std::string file_;
    std::shared_ptr<const EnvironmentImage> image_;
};

}  // namespace mv
