#!/usr/bin/env bash
# Measures speed against error on one scene: makes the references, sweeps, draws.
#   ./measure.sh [SCENE [FOLDER [SETTINGS...]]]
#   ./measure.sh --scenes PLACE...   every method on every scene there: app/bench/scenes.py
#   ./measure.sh --flicker PLACE...  how each flickers while the light moves: app/bench/flicker.py
#   ./measure.sh --paper PLACE...    the experiments of the paper: app/bench/paper.py
#   ./measure.sh --cuts PLACE...     what cuts save that are kept while things move: app/bench/cuts.py
# SCENE: builtin:atrium or a file; FOLDER: where everything goes (measured); SETTINGS: flags of both
# programs, such as --camera 2 --scene-depth 10. What was measured already is kept: run it again to
# go on after an interruption.
set -euo pipefail
if [[ "${1:-}" =~ ^(-h|--help)$ ]]; then
    sed -n '2,/^set/s/^# \{0,1\}//p' "$0"
    exit
fi
if [[ "${1:-}" =~ ^--(scenes|flicker|paper|cuts)$ ]]; then
    script="${1#--}.py"
    shift
    "$(dirname "$0")/install-packages.sh" --plots
    # MEGAVIEWS_PROGRAMS: a folder of programs that are built already
    programs="${MEGAVIEWS_PROGRAMS:-$(dirname "$0")/build}"
    if [ -z "${MEGAVIEWS_PROGRAMS:-}" ]; then
        cmake --preset release -S "$(dirname "$0")" >/dev/null
        cmake --build "$programs" --target megaviews megaviews-bench
    fi
    exec /usr/bin/python3 "$(dirname "$0")/app/bench/$script" --programs "$programs" "$@"
fi
if [[ "${1:-}" == -* ]]; then
    echo "$0: no such option: $1 (--help lists them)" >&2
    exit 2
fi
scene="${1:-builtin:atrium}"
[[ "$scene" == builtin:* ]] || scene="$(realpath -e "$scene")"
mkdir -p "${2:-measured}"
folder="$(realpath "${2:-measured}")"
shift $(($# < 2 ? $# : 2))
# Views, clamp and shadow test as published: what the traversals are compared with.
settings=(--scene-depth 8 --view-depth 8 --resolution 160x90 --no-config --environment none --placement traced
    --clamp-distance 0.01 --near-field off --undecided off
    --gather-candidates 1 "$@")

cd "$(dirname "$0")"
./install-packages.sh --plots
export CCACHE_DIR="${CCACHE_DIR:-$PWD/build/.ccache}"
programs="${MEGAVIEWS_PROGRAMS:-build}"  # a folder of programs that are built already
if [ "$programs" = build ]; then
    cmake --preset release >/dev/null
    cmake --build --preset release --target megaviews megaviews-bench
fi

python=/usr/bin/python3  # the one that has Debian's matplotlib

# Errors are measured at this count of views, which the exact reference has to share.
views=1K
references="$folder/references"
for method in exact pathtraced; do
    "$programs/megaviews" --headless "$scene" "${settings[@]}" --vpls $views --method $method \
        --references "$references" -o "$folder/$method.png"
done

# A request that does not fit is a row of the table and exit code 6: the rest is measured.
sweep() { "$programs/megaviews-bench" sweep "$scene" "${settings[@]}" "$@" --resume || [ $? -eq 6 ]; }
sweep --sweep vpls=256..16K:x2 --sweep method=megaviews,manylods --frames 3 --out "$folder/views"
sweep --vpls $views --sweep gather-samples=8..512:x2 --sweep method=megaviews,manylods,none \
    --frames 3 --references "$references" --out "$folder/error"
"$python" app/bench/plot.py "$folder/views.json" --pictures time,sharing,memory,stages --out "$folder"
"$python" app/bench/plot.py "$folder/error.json" --pictures error --out "$folder"
