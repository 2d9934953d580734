// Pictures taken in the window go to the folder for pictures, under a name that nothing has.

#include "app/common/output_names.h"

#include <gtest/gtest.h>

#include "app/temp_folder.h"

namespace mv {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;
using test::Variable;

TEST(OutputNames, PicturesGoWhereTheUserKeepsThem) {
    const TempFolder folder;
    const std::string home = folder.file("home");
    fs::create_directories(home);
    const Variable homeIs("HOME", home);
    const Variable noConfig("XDG_CONFIG_HOME", std::nullopt);
    {
        const Variable none("XDG_PICTURES_DIR", std::nullopt);
        EXPECT_EQ(picturesFolder(), fs::current_path());
        fs::create_directories(home + "/Pictures");
        EXPECT_EQ(picturesFolder(), home + "/Pictures");
        // In the user's language; what is not there or is the home itself does not count.
        folder.write(
            "home/.config/user-dirs.dirs",
            "# a comment\nXDG_MUSIC_DIR=\"$HOME/Musik\"\nXDG_PICTURES_DIR=\"$HOME/Bilder\"\n");
        EXPECT_EQ(picturesFolder(), home + "/Pictures");
        fs::create_directories(home + "/Bilder");
        EXPECT_EQ(picturesFolder(), home + "/Bilder");
        folder.write("home/.config/user-dirs.dirs", "XDG_PICTURES_DIR=\"$HOME/\"\n");
        EXPECT_EQ(picturesFolder(), home + "/Pictures");
        folder.write("home/.config/user-dirs.dirs", "XDG_PICTURES_DIR=\"\nXDG_PICTURES_DIR=\"\"\n");
        EXPECT_EQ(picturesFolder(), home + "/Pictures");
        folder.write("config/user-dirs.dirs", "XDG_PICTURES_DIR=\"" + home + "/Bilder\"\n");
        const Variable config("XDG_CONFIG_HOME", folder.file("config"));
        EXPECT_EQ(picturesFolder(), home + "/Bilder");
    }
    const Variable pictures("XDG_PICTURES_DIR", folder.file("shots"));
    EXPECT_EQ(picturesFolder(), home + "/Pictures");
    fs::create_directories(folder.file("shots"));
    EXPECT_EQ(picturesFolder(), folder.file("shots"));

    EXPECT_EQ(freeFileName("megaviews", ".png"), folder.file("shots/megaviews-1.png"));
    folder.write("shots/megaviews-1.png", "x");
    folder.write("shots/megaviews-3.png", "x");
    EXPECT_EQ(freeFileName("megaviews", ".png"), folder.file("shots/megaviews-2.png"));
    EXPECT_EQ(freeFileName("megaviews", ".exr"), folder.file("shots/megaviews-1.exr"));
}

TEST(OutputNames, WithoutAHomeTheCurrentFolderIsLeft) {
    const Variable pictures("XDG_PICTURES_DIR", "relative");
    const Variable config("XDG_CONFIG_HOME", std::nullopt);
    for (const std::optional<std::string>& none :
         {std::optional<std::string>(), std::optional<std::string>("")}) {
        const Variable home("HOME", none);
        EXPECT_EQ(picturesFolder(), fs::current_path());
    }
}

}  // namespace
}  // namespace mv
