#!/usr/bin/env bash
# Eight measurements for the first half hour on a GPU, the most telling first. Nothing waits for
# another, and each is cut off after 150 s with what it has.
#   app/bench/first_run.sh [--software] PROGRAMS SCENE OUT [VIEWS]
# PROGRAMS: a folder with megaviews and megaviews-bench; VIEWS: 64K, of which 4 and 16 times as many
# are measured too. Without --software a machine that renders in software is refused at once.
# OUT: sweeps as JSON and CSV, 8.json the statistics of the last, what all of them printed in log.txt.
set -uo pipefail
need=--require-hardware
if [ "${1:-}" = --software ]; then
    need=
    shift
fi
if [ $# -lt 3 ]; then
    sed -n '2,7s/^# \?//p' "$0" >&2
    exit 2
fi
programs=$1 scene=$2 out=$3 views=${4:-64K}
for file in "$programs/megaviews" "$programs/megaviews-bench" "$scene"; do
    if [ ! -f "$file" ] && [[ "$file" != builtin:* ]]; then
        echo "first_run.sh: '$file': there is no such file" >&2
        exit 3
    fi
done
if ! [[ "$views" =~ ^[1-9][0-9]*K?$ ]]; then
    echo "first_run.sh: '$views' is no count of views, such as 64K" >&2
    exit 2
fi
programs=$(realpath "$programs")
unit=${views//[0-9]/} count=${views//[!0-9]/}
more=$((4 * count))$unit most=$((16 * count))$unit
levels="--environment none --scene-depth 11 --view-depth 11"
[[ "$scene" == builtin:* ]] || scene=$(realpath "$scene")
mkdir -p "$out" && cd "$out" || exit 5
exec > >(tee log.txt) 2>&1

failed=0
# step NUMBER TITLE COMMAND...
step() {
    local number=$1 title=$2
    shift 2
    echo "== $number: $title"
    timeout --signal=INT --kill-after=10 150 "$@"
    local code=$?
    [ $code -eq 0 ] || { echo "== $number: exit code $code"; failed=$code; }
}
# Maps alone: a small picture, one sample. What is measured is every leaf's map.
sweep() {
    step "$1" "$2" "$programs/megaviews-bench" sweep "$scene" $need --no-config $levels --placement traced \
        --resolution 64x36 --gather-samples 1 --gather-candidates 1 --filter off --near-field off \
        --undecided off --clamp-distance 0.01 --gpu-memory 16384 --queue-memory 4096 --out "${1// /-}" "${@:3}"
}

"$programs/megaviews" --version
step 1 "selftest: the same maps as the CPU's" "$programs/megaviews-bench" selftest $need
[ $failed -ne 4 ] || exit 4  # it renders in software
sweep 2 "$views views: stages, pairs, ratio" --vpls "$views" --sweep distribution=single,bounces,particles \
    --sweep method=megaviews,manylods --frames 5
sweep 3 "$more and $most views: growth, passes, memory" --sweep "vpls=$more,$most" \
    --sweep distribution=single,bounces --sweep method=megaviews,manylods --frames 3
for groups in off on; do
    MEGAVIEWS_GL_WORKAROUNDS="small-groups=$groups" sweep "4 small groups $groups" "the size of work groups" \
        --vpls "$views" --sweep distribution=single,bounces --sweep method=megaviews,manylods --frames 5
done
for left in "--hole-fill off" "--fusion off" "--pair-size 0.5" "--view-res 32"; do
    sweep "5 $left" "one thing otherwise: $left" --vpls "$views" --bounces 4 $left \
        --sweep method=megaviews,manylods --frames 5
done
sweep 6 "queue against lists, both rules" --vpls "$views" --sweep traversal=lists,queue \
    --sweep rules=corrected,published --sweep method=megaviews,manylods --frames 3
for size in 640x360 1280x720 1920x1080; do
    step "7 $size" "maps or marching: what a sample costs" "$programs/megaviews-bench" sweep "$scene" $need \
        --no-config $levels --vpls 16K --resolution $size --sweep gather-samples=16,64 \
        --sweep method=megaviews,rays,shadow-rays --frames 3 --out "7-$size"
done
step 8 "a frame of 1920x1080 with $most moving views" "$programs/megaviews" --headless "$scene" $need \
    --no-config $levels --vpls "$most" --resolution 1920x1080 --gpu-memory 16384 --queue-memory 4096 \
    --frames 60 --warmup 5 --stats 8.json -o 8.png
echo "== done; what is in $out belongs under docs/, with the driver and the commit that the files name"
exit $failed
