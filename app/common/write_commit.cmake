# Writes OUTPUT, a header that names the commit checked out in ROOT; empty outside a checkout, such
# as in a tarball, also where that lies inside another one. An unchanged header keeps its time.
cmake_minimum_required(VERSION 3.20)
set(commit "")
if(EXISTS "${ROOT}/.git")
    execute_process(COMMAND git -C "${ROOT}" describe --always --abbrev=12 --exclude * --dirty
        OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT "#define MEGAVIEWS_COMMIT \"@commit@\"\n" @ONLY)
