#!/usr/bin/env bash
# Installs what building and running need from Debian 12's own packages; with --plots also what
# draws measurements, which tests and measure.sh do. Does nothing if all of it is there.
set -euo pipefail

packages=(
    cmake ninja-build g++ clang pkg-config git ccache
    libglfw3-dev libimgui-dev libglm-dev libtinygltf-dev libopenimageio-dev libstb-dev
    libepoxy-dev libegl-dev libgl-dev libembree-dev libtbb-dev libcli11-dev nlohmann-json3-dev
    libspdlog-dev libgtest-dev
    libgl1-mesa-dri libegl1 xvfb xauth
    python3 python3-numpy
)
[ "${1:-}" = --plots ] && packages+=(python3-matplotlib)

missing=()
for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' ||
        missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
echo "installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
