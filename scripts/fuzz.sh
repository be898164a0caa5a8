#!/usr/bin/env bash
# Builds the fuzz targets (tests/fuzz) and runs each for some seconds, as many at a time as there
# are cores; prints executions and findings. Exit code 1 when there is one.
#
#   scripts/fuzz.sh SECONDS [TARGET...]      TARGET: scene, mesh, fclib, ... ; none: all
#
# An input that breaks something is left in build/fuzz/findings/<target>; run it again with
# build/fuzz/bin/<target>_fuzz FILE. What was learnt is kept in build/fuzz/corpus/<target>.
# JOBS=1 runs one target at a time. SEED=N makes the inputs those of the last run with N, as far as
# the time goes; without it every run tries others. OPTIMISE=-O0 builds in two thirds of the time
# what then makes half as many executions: for a short look.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:?"usage: scripts/fuzz.sh SECONDS [TARGET...]"}
shift

# An allocation above 1 GB, 2 GB in all, or 10 s for one input are findings too.
limits=(-malloc_limit_mb=1024 -rss_limit_mb=2048 -timeout=10 -max_len=8192)

# run_one TARGET
run_one() {
  local name=$1 seeds=tests/fuzz/corpus/$1 folder=build/fuzz words=() log runs found
  mkdir -p "$folder/corpus/$name" "$folder/findings/$name" "$folder/logs"
  log=$folder/logs/$name.log
  [ -f "tests/fuzz/words/$name.txt" ] && words=(-dict="tests/fuzz/words/$name.txt")
  "$folder/bin/${name}_fuzz" "${limits[@]}" "${words[@]}" -max_total_time="$seconds" \
    -seed="${SEED:-0}" \
    -print_final_stats=1 -artifact_prefix="$folder/findings/$name/" \
    "$folder/corpus/$name" "$seeds" >"$log" 2>&1 && found=none || found="a finding, see $log"
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  printf '%-12s %10s executions in %s s: %s\n' "$name" "${runs:-?}" "$seconds" "$found"
  # where nobody can open the log: what was found, and the input
  [ "$found" = none ] || grep -v -e '^#[0-9]*\s[A-Z]' -e '# Uses:' "$log" | tail -n 40 | cut -c1-2000
  [ "$found" = none ]
}

echo "== building the fuzz targets (preset fuzz)"
{ cmake --preset fuzz ${OPTIMISE:+"-DCMAKE_CXX_FLAGS_DEBUG=$OPTIMISE -g1"} &&
  cmake --build --preset fuzz; } >build-fuzz.log 2>&1 ||
  { tail -n 40 build-fuzz.log; exit 1; }
if [ $# = 0 ]; then
  set -- tests/fuzz/*_fuzz.cpp
  set -- "${@##*/}"
  set -- "${@%_fuzz.cpp}"
fi
echo "== fuzzing $# targets, $seconds s each"
[ ! -d /dev/shm ] || export TMPDIR=/dev/shm  # inputs lie in memory
export -f run_one
export seconds
export limits_text="${limits[*]}"
printf '%s\n' "$@" | xargs -P "${JOBS:-$(nproc)}" -I{} bash -c \
  'limits=($limits_text); run_one {} || exit 1' || exit 1
