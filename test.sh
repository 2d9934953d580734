#!/usr/bin/env bash
# Installs packages, builds with g++, runs every test; then builds with clang, AddressSanitizer and
# UndefinedBehaviorSanitizer and runs the tests that need no OpenGL once more. (The GL tests are
# left out there: Mesa's JIT-compiled code is not instrumented, and its own leaks drown ours.)
# With --quick: only the first half.
set -euo pipefail
cd "$(dirname "$0")"
./install-packages.sh --plots

cmake --preset release >/dev/null
cmake --build --preset release
# No display and the software rasteriser: what every machine can repeat.
unset DISPLAY WAYLAND_DISPLAY
ctest --test-dir build --output-on-failure -j 2 | tee build/ctest.log
# With the packages above only tests of scene files that are not in this repository may be skipped.
needed='gl|gpu|image|cli|ui|viewer|baselines|reference_pictures|bench|views'
if [ "${CI:-}" = true ] && grep -E "^[[:space:]]*[0-9]+ - ($needed)\..*\(Skipped\)" build/ctest.log; then
    echo "tests that need an OpenGL context, matplotlib or NumPy were skipped" >&2
    exit 1
fi
[ "${1:-}" = --quick ] && exit 0

cmake --preset asan >/dev/null
cmake --build --preset asan
ctest --test-dir build-asan --output-on-failure -j 2 -L cpu
