#include "megaviews/settings/settings_rows.h"

#include "megaviews/core/error.h"
#include "megaviews/settings/light_placement.h"

namespace mv::rows {
namespace {

void checkLights(std::string_view text, std::string_view where) {
    parseLightPlacements(text, where);
}
void checkEnvironment(std::string_view text, std::string_view where) {
    if (!text.empty()) return;
    throw Error(ExitCode::usage,
                std::string(where) + ": '' names neither an environment nor a file");
}

}  // namespace

std::vector<SettingInfo> ofScene() {
    using S = Settings;
    return {
        {.key = "camera",
         .label = "Camera",
         .field = TextField{field(&S::camera, &CameraSettings::name)},
         .help = "Camera of the scene by name or number; empty takes the first."},
        {.key = "camera-position",
         .label = "Camera position",
         .field = field(&S::camera, &CameraSettings::position),
         .minimum = -1e12,
         .maximum = 1e12,
         .unset = "auto",
         .unit = "world units",
         .help = "Where the camera stands, instead of the scene's camera."},
        {.key = "camera-target",
         .label = "Camera target",
         .field = field(&S::camera, &CameraSettings::target),
         .minimum = -1e12,
         .maximum = 1e12,
         .unset = "auto",
         .unit = "world units",
         .help = "The point the camera looks at."},
        {.key = "camera-up",
         .label = "Camera up",
         .field = field(&S::camera, &CameraSettings::up),
         .minimum = -1e12,
         .maximum = 1e12,
         .help = "Which way is up when a camera position or target is given."},
        {.key = "fov",
         .label = "Field of view",
         .field = field(&S::camera, &CameraSettings::fovDeg),
         .minimum = 1,
         .maximum = 179,
         .unset = "auto",
         .unit = "degrees",
         .help = "Vertical field of view, instead of the camera's own."},
        {.key = "file-scene",
         .label = "Scene of the file",
         .field = field(&S::scene, &SceneSettings::fileScene),
         .minimum = 0,
         .maximum = 65535,
         .unset = "default",
         .help = "Which of a glTF file's scenes is shown, counted from 0; --info lists them."},
        {.key = "variant",
         .label = "Material variant",
         .field = TextField{field(&S::scene, &SceneSettings::variant)},
         .help = "Variant of a glTF file's materials by name or number; empty takes the materials "
                 "that the file shows without; --info lists them."},
        {.key = "animation",
         .label = "Animation",
         .field = TextField{field(&S::scene, &SceneSettings::animation)},
         .help = "Animation of the scene by name or number, or none; empty takes all, which plays "
                 "together what a file has where no two move the same, or the first."},
        {.key = "time",
         .label = "Time",
         .field = field(&S::scene, &SceneSettings::timeS),
         .minimum = -1e9,
         .maximum = 1e9,
         .unit = "s",
         .help = "Time of the first frame in the animation."},
        {.key = "light-scale",
         .label = "Light scale",
         .field = field(&S::scene, &SceneSettings::lightScale),
         .minimum = 0,
         .maximum = 1e9,
         .help = "Factor on every light of the scene, emissive surfaces included."},
        {.key = "lights",
         .label = "Lights",
         .field =
             TextField{field(&S::scene, &SceneSettings::lights), "N:X,Y,Z[:X,Y,Z]", checkLights},
         .help =
             "Lights put elsewhere or changed: LIGHT:X,Y,Z:DX,DY,DZ:R,G,B:INNER,OUTER are place, "
             "direction, intensity and cone in the file's units and degrees; what is empty or "
             "left out stays, several are separated by spaces."},
        {.key = "materials",
         .label = "Materials",
         .field = choice(field(&S::scene, &SceneSettings::materials), {"lambert", "full"}),
         .help = "What is shown of a file's materials: lambert (base colour, emission and masks: "
                 "matt surfaces), or full (metal, roughness and normal maps too, what gloss, "
                 "mirrors and clear coats reflect, and what is seen through glass)."},
        {.key = "environment",
         .label = "Environment",
         .field =
             TextField{field(&S::scene, &SceneSettings::environment, &EnvironmentSettings::source),
                       "auto|none|sky|white|FILE", checkEnvironment},
         .help = "The light around the scene: auto (a sky where a sun was placed because the file "
                 "has no light), none, sky (a gradient about the scene's sun), white (1 W/m²/sr "
                 "from everywhere), or an image file, EXR or HDR, of latitude and longitude. white "
                 "and images stand instead of a light that was placed."},
        {.key = "sky-rotation",
         .label = "Sky rotation",
         .field = field(&S::scene, &SceneSettings::environment, &EnvironmentSettings::rotationDeg),
         .minimum = -360,
         .maximum = 360,
         .unit = "degrees",
         .help = "Turns an environment image about the vertical, counter-clockwise seen from "
                 "above; skies of sun and gradient stand."},
        {.key = "sky-scale",
         .label = "Sky scale",
         .field = field(&S::scene, &SceneSettings::environment, &EnvironmentSettings::scale),
         .minimum = 0,
         .maximum = 1e9,
         .help = "Factor on the environment's light, beside that on every light."},
    };
}

}  // namespace mv::rows
