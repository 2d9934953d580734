#include "app/common/program_version.h"

#include "program_commit.h"  // written by every build, see write_commit.cmake

namespace mv {

std::string programVersion() { return MEGAVIEWS_VERSION; }
std::string programCommit() { return MEGAVIEWS_COMMIT; }
std::string programBuildType() { return MEGAVIEWS_BUILD_TYPE; }

}  // namespace mv
