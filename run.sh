#!/usr/bin/env bash
# Installs packages, builds, and starts the viewer on its default scene; arguments go to it. Without
# a display it renders a picture instead and says where it is.
set -euo pipefail
cd "$(dirname "$0")"
./install-packages.sh
export CCACHE_DIR="${CCACHE_DIR:-$PWD/build/.ccache}"
cmake --preset release >/dev/null
cmake --build --preset release --target megaviews
exec build/megaviews "$@"
