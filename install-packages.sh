#!/usr/bin/env bash
# Installs what building and running need from Debian 12's own packages; with --plots also what
# draws measurements, which tests and measure.sh do, and a font for names that tests show; with
# --checks also what .ci/run checks with.
# Says what it will install before it does. Does nothing, and needs no rights, if all of it is there.
set -euo pipefail

packages=(
    cmake ninja-build g++ clang pkg-config git ccache
    libglfw3-dev libimgui-dev libglm-dev libtinygltf-dev libopenimageio-dev libstb-dev
    libepoxy-dev libegl-dev libgl-dev libembree-dev libtbb-dev libcli11-dev nlohmann-json3-dev
    libdraco-dev libmeshoptimizer-dev libwebp-dev
    libspdlog-dev libgtest-dev libxxhash-dev libutfcpp-dev libfontconfig-dev
    libgl1-mesa-dri libegl1 xvfb xauth
    python3 python3-numpy
)
for option in "$@"; do
    case "$option" in
        --plots) packages+=(python3-matplotlib python3-openimageio fonts-droid-fallback) ;;
        --checks) packages+=(clang-format clang-tidy glslang-tools) ;;
        *) echo "usage: $0 [--plots] [--checks]" >&2; exit 2 ;;
    esac
done

missing=()
for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' ||
        missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if ! command -v apt-get >/dev/null; then
    echo "$0: this system has no apt-get; what these Debian packages hold is needed: ${missing[*]}" >&2
    exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "$0: packages are missing, and without root or sudo they cannot be installed: ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
echo "Missing Debian packages, installed now with ${as_root[*]:+sudo }apt-get: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
