#pragma once
// Measures a rendered picture against a reference file: --reference, --metrics, --threshold,
// --diff.

#include <optional>
#include <string>

#include "app/common/measuring.h"
#include "app/common/run_options.h"
#include "app/viewer/image_io.h"

namespace mv {

// Radiance or display values, not numbers that views show in colours of their own.
bool isPicture(DebugView view);

class Measure {
  public:
    // Reads the reference. A setting of `settings` that decides how the picture is displayed and
    // was not given takes the reference's value, if the reference names one: exposure and tone map.
    // Throws Error(ExitCode::input) if the file cannot be read, Error(ExitCode::usage) if it has
    // another size, or if what is asked for cannot be measured against it.
    Measure(const RunOptions& options, Settings& settings);

    // The renderer's last picture. Writes the file of --diff.
    Measurement of(const FrameRenderer& renderer, const Settings& settings, double exposureEv);

  private:
    MeasureOptions options_;
    ReferenceImage reference_;
    std::vector<Metric> metrics_;
};

}  // namespace mv
