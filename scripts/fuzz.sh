#!/usr/bin/env bash
# Builds the fuzz targets (tests/fuzz) and runs each for some seconds, as many at a time as there
# are cores; prints executions and findings. Exit code 1 when there is a finding.
#
#   scripts/fuzz.sh SECONDS [TARGET...]      TARGET: scene, mesh, fclib, ... ; none: all
#   scripts/fuzz.sh build                    only builds them
#   scripts/fuzz.sh table                    what all runs of this folder did, target by target
#
# The next run continues from the last: its inputs are kept in build/fuzz/corpus/<target>, and runs
# of a minute or more reduce them to those that are needed.
# An input that breaks something is left in build/fuzz/findings/<target>; run it again with
# build/fuzz/bin/<target>_fuzz FILE.
# JOBS=1 runs one target at a time. SEED=N gives the inputs of the last run with N, as far as the
# time goes; without it every run tries others. OPTIMISE=-O0 builds in two thirds of the time, but
# the targets make half as many executions: for a short look.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:?"usage: scripts/fuzz.sh SECONDS [TARGET...] | build | table"}
shift
export ledger=build/fuzz/ledger.csv  # a line for every run of a target

if [ "$seconds" = table ]; then
  awk -F, '{
    cpu[$2] += $3; executions[$2] += $4; covered[$2] = $5; edges[$2] = $6; kept[$2] = $7
    found[$2] += $8
  } END {
    print "| target | CPU hours | executions | edges reached, of | inputs kept | findings |"
    print "|---|---|---|---|---|---|"
    for (t in cpu)
      printf "| `%s` | %.2f | %d | %d of %d | %d | %d |\n", t, cpu[t] / 3600, executions[t],
        covered[t], edges[t], kept[t], found[t] | "sort"
  }' "$ledger"
  exit
fi

# An allocation above 1 GB, 2 GB in all, or 10 s for one input are findings too.
limits=(-malloc_limit_mb=1024 -rss_limit_mb=2048 -timeout=10 -max_len=8192)

# run_one TARGET
run_one() {
  local name=$1 seeds=tests/fuzz/corpus/$1 folder=build/fuzz words=() log runs edges covered found=0
  local corpus=$folder/corpus/$1
  mkdir -p "$corpus" "$folder/findings/$name" "$folder/logs"
  log=$folder/logs/$name.log
  [ -f "tests/fuzz/words/$name.txt" ] && words=(-dict="tests/fuzz/words/$name.txt")
  TIMEFORMAT='%U %S'
  { time "$folder/bin/${name}_fuzz" "${limits[@]}" "${words[@]}" -max_total_time="$seconds" \
    -seed="${SEED:-0}" \
    -print_final_stats=1 -artifact_prefix="$folder/findings/$name/" \
    "$corpus" "$seeds" >"$log" 2>&1; } 2>"$log.time" || found=1
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  edges=$(sed -n 's/^INFO: Loaded 1 PC tables (\([0-9]*\).*/\1/p' "$log")
  covered=$(sed -n 's/^#.* cov: \([0-9]*\).*/\1/p' "$log" | tail -n 1)
  printf '%-12s %10s executions in %s s, %s of %s edges: %s\n' "$name" "${runs:-?}" "$seconds" \
    "${covered:-?}" "${edges:-?}" "$([ $found = 0 ] && echo none || echo "a finding, see $log")"
  # prints the finding and the input, for where nobody can open the log
  [ $found = 0 ] || grep -v -e '^#[0-9]*\s[A-Z]' -e '# Uses:' "$log" | tail -n 40 | cut -c1-2000
  [ $found = 1 ] || [ "$seconds" -lt 60 ] || reduce_corpus
  printf '%s,%s,%.1f,%s,%s,%s,%s,%s\n' "$(date +%F)" "$name" \
    "$(awk '{ print $1 + $2 }' "$log.time")" "${runs:-0}" "${covered:-0}" "${edges:-0}" \
    "$(find "$corpus" -type f | wc -l)" $found >>"$ledger"
  [ $found = 0 ]
}

# Keeps the smallest of the inputs that reach the same code.
reduce_corpus() {
  rm -rf "$corpus.reduced"
  mkdir "$corpus.reduced"
  "$folder/bin/${name}_fuzz" "${limits[@]}" -merge=1 "$corpus.reduced" "$seeds" "$corpus" \
    >"$log.merge" 2>&1 || return 0
  rm -rf "$corpus"
  mv "$corpus.reduced" "$corpus"
}

echo "== building the fuzz targets (preset fuzz)"
{ cmake --preset fuzz ${OPTIMISE:+"-DCMAKE_CXX_FLAGS_DEBUG=$OPTIMISE -g1"} &&
  cmake --build --preset fuzz; } >build-fuzz.log 2>&1 ||
  { tail -n 40 build-fuzz.log; exit 1; }
[ "$seconds" != build ] || exit 0
if [ $# = 0 ]; then
  set -- tests/fuzz/*_fuzz.cpp
  set -- "${@##*/}"
  set -- "${@%_fuzz.cpp}"
fi
echo "== fuzzing $# targets, $seconds s each"
[ ! -d /dev/shm ] || export TMPDIR=/dev/shm  # inputs lie in memory
export -f run_one reduce_corpus
export seconds
export limits_text="${limits[*]}"
printf '%s\n' "$@" | xargs -P "${JOBS:-$(nproc)}" -I{} bash -c \
  'limits=($limits_text); run_one {} || exit 1' || exit 1
