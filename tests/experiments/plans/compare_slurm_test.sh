#!/usr/bin/env bash
# A comparison on a cluster: `ballast compare --snakemake` with a backend and a program of its own on a one-node Slurm. A worker is
# killed with -9 in the middle of a solve: that solve is a row, the rest is solved, nothing is left running.
#
#   compare_slurm_test.sh BALLAST      exit code 77: skipped, with the reason on standard output
source "$(dirname "$(realpath "$0")")/one_node_slurm.sh"

# A solver that hangs in its first solve of all, and says who it is. Its command is relative to the folder of the comparison.
cat >"$folder/slow.sh" <<END
mkdir "$folder/first" 2>/dev/null && echo \$\$ >"$folder/first/id" && sleep 600
exec "$ballast" answer --solver pgs "\$@"
END

parent_of() { sed 's/.*) . //; s/ .*//' "/proc/$1/stat"; }
is_ballast() { [ "$(readlink "/proc/$1/exe")" = "$ballast" ]; }

# Kills the worker of the hanging solver: the uppermost ballast above it. Prints its id.
kill_worker() {
  local id worker=
  for _ in $(seq 600); do
    [ -s "$folder/first/id" ] && break
    kill -0 "$snakemake_id" 2>/dev/null || return
    sleep 0.05
  done
  id=$(cat "$folder/first/id") || return
  while [ "$id" -gt 1 ]; do
    id=$(parent_of "$id")
    if is_ballast "$id"; then worker=$id; elif [ -n "$worker" ]; then break; fi
  done
  [ -n "$worker" ] && kill -9 "$worker" && echo "$worker"
}

start_slurm
cd "$folder" || exit 1
"$ballast" compare known:contacts=6,bodies=4,count=2 --solvers pgs --external slow="sh slow.sh" --tolerances 1e-2,1e-6 \
  --max-seconds 100 --output results --snakemake jobs >log/written || fail "--snakemake"
cd jobs || exit 1
run_and_kill kill_worker "in the middle of a solve"
! kill -0 "$(cat "$folder/first/id")" 2>/dev/null || fail "the killed worker's program still runs"
[ "$jobs" = 5 ] || fail "$jobs jobs ran in Slurm; 2 cases by pgs and by slow, and one that was killed are 5"

# Column `verdict`, by its name; notes in quotes stand behind it.
verdicts=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "verdict") c = i; next } { print $c }' "$folder/results/results.csv" |
  sort | uniq -c | xargs)
[ "$verdicts" = "1 crashed 7 solved" ] || fail "verdicts of 8 solves, one of them killed: $verdicts"
[ -s "$folder/results/compare.html" ] || fail "no page"
echo "PASSED: 8 rows of 5 jobs, the one that was killed among them"
