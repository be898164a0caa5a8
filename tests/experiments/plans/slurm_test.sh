#!/usr/bin/env bash
# The plan on a cluster: `ballast plan --snakemake` on a one-node Slurm that this script starts and ends, a worker killed with -9
# in the middle of its run, against the local engine: the same bits.
#
#   slurm_test.sh BALLAST      exit code 77: skipped, with the reason on standard output
source "$(dirname "$(realpath "$0")")/one_node_slurm.sh"

# --- the plan ---------------------------------------------------------------------------------------------------------------------
# That of small_plan.hpp, ten times as long, so that a worker can be found in the middle of its run.
sed -n '/R"(/,/^)";/{//!p}' "$(dirname "$(realpath "$0")")/small_plan.hpp" |
  sed 's/duration=0.06/duration=0.6/; s/checkpoint_seconds=0.02/checkpoint_seconds=0.1/' >"$folder/plan.toml"
grep -q 'duration=0.6"' "$folder/plan.toml" && grep -q 'checkpoint_seconds=0.1"' "$folder/plan.toml" || fail "the plan of small_plan.hpp has changed"

# All columns of a record but the wall clocks.
physics() {
  awk -F, -v OFS=, 'NR == 1 { for (i = 1; i <= NF; ++i) keep[i] = $i !~ /^seconds_/ }
                    { line = ""; for (i = 1; i <= NF; ++i) if (keep[i]) line = line OFS $i; print line }' "$1"
}

# Kills the first run found in the middle of its drive: a checkpoint is there, the record is not. Prints the run's folder.
kill_a_worker() {
  local run id
  for _ in $(seq 1200); do
    for run in "$folder"/cluster/runs/*/; do
      [ -e "$run/checkpoint.bin" ] && [ ! -e "$run/steps.csv" ] || continue
      id=$(sed -n 's/^process \([0-9]*\) on .*/\1/p' "$run/run.lock" 2>/dev/null)
      [ -n "$id" ] && [ "$(readlink "/proc/$id/exe")" = "$ballast" ] && kill -9 "$id" && { echo "$run"; return; }
    done
    kill -0 "$snakemake_id" 2>/dev/null || return
    sleep 0.05
  done
}

start_slurm
echo "Slurm $(slurmctld -V | cut -d' ' -f2), Snakemake $(snakemake --version)"
"$ballast" plan "$folder/plan.toml" --output "$folder/local" --jobs 2 >"$folder/log/local" 2>&1 || { cat "$folder/log/local"; fail "the local plan"; }
"$ballast" plan "$folder/plan.toml" --output "$folder/cluster" --snakemake "$folder/jobs" >/dev/null || fail "--snakemake"
cd "$folder/jobs" || exit 1
run_and_kill kill_a_worker "in the middle of its run"
echo "killed with -9: $(basename "$killed")"
[ "$jobs" -ge 7 ] || fail "$jobs jobs ran in Slurm; 2 packings, 4 runs and one that was killed are 7"
grep -q '"step": [1-9]' <(sed -n '/"resumed"/,/\]/p' "$killed/manifest.json") || fail "the killed run was not resumed at a checkpoint"
compared=0
for run in "$folder"/local/runs/*/; do
  key=$(basename "$run")
  cmp <(physics "$run/steps.csv") <(physics "$folder/cluster/runs/$key/steps.csv") || fail "$key: not the same as the local engine's"
  compared=$((compared + 1))
done
[ "$compared" = 4 ] || fail "$compared runs compared, not 4"
[ "$(grep -c ',finished,' "$folder/cluster/index.csv")" = 4 ] || fail "index.csv"
echo "PASSED: 4 runs of $(($(wc -l <"$folder/cluster/runs/$key/steps.csv") - 1)) steps, bit for bit those of the local engine"
