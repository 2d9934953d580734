#!/usr/bin/env bash
# Installs packages, builds with g++, runs every test; then builds with clang, AddressSanitizer and
# UndefinedBehaviorSanitizer and runs the tests that need no OpenGL once more. (The GL tests are
# left out there: Mesa's JIT-compiled code is not instrumented, and its own leaks drown ours.)
# With --quick: only the first half.
set -euo pipefail
case "${1:-}" in
    '' | --quick) ;;
    -h | --help)
        sed -n '2,/^set/s/^# \{0,1\}//p' "$0"
        exit
        ;;
    *)
        echo "usage: $0 [--quick]" >&2
        exit 2
        ;;
esac
cd "$(dirname "$0")"
./install-packages.sh --plots

cmake --preset release >/dev/null
cmake --build --preset release
# No display and the software rasteriser: what every machine can repeat.
unset DISPLAY WAYLAND_DISPLAY
rm -rf build/test-results
ctest --test-dir build --output-on-failure -j 2
tests/list_skipped.sh build/test-results
[ "${1:-}" = --quick ] && exit 0

cmake --preset asan >/dev/null
cmake --build --preset asan --target cpu_tests
ctest --test-dir build-asan --output-on-failure -j 2 -L cpu
