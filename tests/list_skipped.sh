#!/usr/bin/env bash
# Lists the tests that were skipped, with their reasons, from the XML files that they left in FOLDER.
# In CI (CI=true) every tool is there, so only scenes that are not in this repository may be missing:
# another skipped test is an error, and so is a folder without results.
#   tests/list_skipped.sh FOLDER
set -euo pipefail
shopt -s nullglob
results=("$1"/*.xml)
[ ${#results[@]} -gt 0 ] || { echo "$0: no results in $1" >&2; exit 1; }

skipped=$(awk '
    /<testcase / { match($0, / name="[^"]*"/); test = substr($0, RSTART + 7, RLENGTH - 8)
                   match($0, / classname="[^"]*"/); suite = substr($0, RSTART + 12, RLENGTH - 13) }
    /<skipped /  { match($0, / message="[^"]*"/); why = substr($0, RSTART + 10, RLENGTH - 11)
                   gsub(/&#x0A;/, " ", why); gsub(/&quot;/, "\"", why)
                   program = FILENAME; sub(/.*\//, "", program); sub(/\..*/, "", program)
                   print program "." suite "." test ": " why }' "${results[@]}")
[ -n "$skipped" ] || exit 0
echo "skipped:"
echo "$skipped"
if [ "${CI:-}" = true ] && echo "$skipped" | grep -qv '^scene\.'; then
    echo "tests that need an OpenGL context, matplotlib or NumPy were skipped" >&2
    exit 1
fi
