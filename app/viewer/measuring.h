#pragma once
// What is made and measured of pictures beside rendering them, mostly on threads of their own and
// polled once a frame: the light of references, FLIP between two sides, the numbers of the errors
// panel, exact maps with the errors of the methods' maps against them, and what --reference,
// --metrics, --threshold and --diff ask for.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "app/common/run_options.h"
#include "app/viewer/image_io.h"
#include "app/viewer/reference_worker.h"
#include "megaviews/measure/map_errors.h"
#include "megaviews/measure/picture_errors.h"
#include "renderer/frame_renderer.h"
#include "ui/model.h"

namespace mv {

class Measuring {
  public:
    // Reads the file of --reference. Throws Error(ExitCode::input).
    explicit Measuring(const RunOptions& options);

    // Before a picture is measured against the file: a setting that decides how pictures are
    // displayed and was not given takes the file's value, if that names one. Throws
    // Error(ExitCode::usage) if the picture will have another size or show data, or if what is
    // asked for cannot be measured against the file.
    void prepare(const RunOptions& options, Settings& settings) const;
    // The renderer's last picture against the file. Writes the file of --diff.
    Measurement measure(const FrameRenderer& renderer, const Settings& settings) const;

    // What the errors panel measures against from now on: a file (throws Error(ExitCode::input)),
    // or a side of the last picture as it is.
    void loadReference(const std::string& file);
    void keepReference(const FrameRenderer& renderer, const Settings& settings,
                       const FrameCamera& camera, int side);

    // Abandons what it makes. The scene is kept as long as it is needed.
    void setScene(std::shared_ptr<const SceneAssets> assets);

    // Abandons what it makes, and returns when nobody reads the scene any more.
    void rest() { references_.rest(); }

    // Hands the renderer what its last frame lacks of references and FLIP, as far as it is there,
    // and begins what is not, unless something moves. True: the next frame shows more.
    bool supply(FrameRenderer& renderer, const Settings& settings, const FrameMoment& moment,
                bool moving);

    // The errors of each side's maps against exact maps of `views` views, which are begun once
    // nothing makes other views any more; 0: nothing is asked for. settings: not those of a draft.
    struct SideMaps {
        bool waits = false;                      // more calls are needed
        const MapErrorReport* report = nullptr;  // until the next call; null: none (yet)
    };
    std::array<SideMaps, 2> measureMaps(const FrameRenderer& renderer, const Settings& settings,
                                        const FrameMoment& moment, int views, bool draft);

    // The picture that stands in a window.
    struct Picture {
        const Settings& settings;  // in effect
        const Settings& wanted;    // the same but for a draft
        const FrameMoment& moment;
        std::uint64_t number;  // of the picture
        bool draft, still;
    };
    // Fills the errors panel and measures what is missing in it; picture null: it is closed.
    void fill(const FrameRenderer& renderer, const Picture* picture, ui::ErrorsData& data);
    // Whether what fill() gave last misses something that is to come.
    bool unfinished(const ui::ErrorsData& data) const;

    // Something is being made or measured on another thread.
    bool busy() const { return references_.busy() || errors_.busy() || flip_.busy(); }
    const ReferenceWorker& references() const { return references_; }
    // Why a reference or exact maps could not be made; each once.
    std::optional<ReferenceWorker::Failure> takeFailure() { return references_.takeFailure(); }
    // Why errors, or FLIP's picture, could not be measured; each once.
    std::optional<Error> takeErrorsFailure();

  private:
    void fillPictures(const FrameRenderer& renderer, const Picture& picture, ui::ErrorsData& data);

    const MeasureOptions options_;
    // That of --reference, and that of the errors panel: a file or a picture that was kept.
    std::shared_ptr<const ReferenceImage> given_, reference_;
    std::string referenceName_;
    // Camera and scene name of a picture that was kept.
    std::optional<FrameCamera> keptFrom_;
    std::string keptOf_;
    std::string sceneName_;  // of the one that stands
    ReferenceWorker references_;
    std::array<std::uint64_t, 2> begun_{};  // wanted references that were begun, by side
    PictureErrors errors_, flip_;

    // How a side's maps were measured.
    struct MeasuredMaps {
        // What its exact maps were begun for, if for this side.
        struct Wanted {
            std::uint64_t viewsVersion = 0;
            int mapRes = 0, count = 0;
            bool operator==(const Wanted&) const = default;
        };
        std::optional<Wanted> wanted;
        // What was compared; null: nothing yet.
        std::shared_ptr<const MapReferences> exact;
        std::uint64_t version = 0;
        MapErrorReport report;
    };
    std::array<MeasuredMaps, 2> measuredMaps_;
    std::uint64_t lastViews_ = 0;  // FrameRenderer::viewsVersion at the last call
};

}  // namespace mv
