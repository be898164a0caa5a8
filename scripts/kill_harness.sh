#!/usr/bin/env bash
# Kills the program with -9 at random moments of each activity - run, deposit, plan, compare, paper,
# collect, archive - and restarts it, again and again, until it ends. The results must have the bits
# of an undisturbed run.
#
#   scripts/kill_harness.sh [--kills N] [--seed S] [--only "run compare"] [--ballast PROGRAM]
#                           [--report FILE]
#   sudo scripts/kill_harness.sh --disks N [--only ...]
#
# N kills in all (100), shared among the activities. Prints a report (Markdown), and writes it to
# FILE. Exit code 1 when anything differs, or when the program ends in another way than by success.
# With --disks each activity is begun on N disks instead, from an almost empty one to one that lacks
# little. It must end with exit code 1 and name a file; when the disk has grown, the same command
# must go on to the same bits.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
kills=100 disks=0 seed=1 only="run deposit plan compare paper collect archive" report=
ballast=$root/build/default/bin/ballast
while [ $# -gt 0 ]; do
  case $1 in
    --kills) kills=$2 ;;
    --disks) disks=$2 ;;
    --seed) seed=$2 ;;
    --only) only=$2 ;;
    --ballast) ballast=$2 ;;
    --report) report=$2 ;;
    *) sed -n '2,15p' "${BASH_SOURCE[0]}" | sed 's/^# \{0,1\}//'; exit 2 ;;
  esac
  shift 2
done
export OPENBLAS_NUM_THREADS=1
folder=$(mktemp -d "${TMPDIR:-/tmp}/ballast_kills_XXXXXX")
trap 'umount "$folder/disk" 2>/dev/null || true; rm -rf "$folder"' EXIT
RANDOM=$seed

# Twenty grains, checkpoints every 20 ms.
small=(--set grains.count=20 --set box.length=0.14 --set box.width=0.14
       --set record.checkpoint_seconds=0.02)
cat >"$folder/plan.toml" <<'PLAN'
scene = "vibrated_box_small"
set = ["grains.count=20", "box.length=0.14", "box.width=0.14", "scene.duration=0.05",
       "record.checkpoint_seconds=0.02"]
[[grid]]
name = "nu"
vary."drive.frequency" = [5, 20]
vary."grains.seed" = [1, 2]
PLAN

cat >"$folder/collection.toml" <<'LIST'
[[family]]
name = "jammed"
scene = "vibrated_box_small"
set = ["record.forces=false", "grains.count=20", "box.length=0.14", "box.width=0.14",
  "scene.duration=0.05", "record.checkpoint_seconds=0.02"]
vary = [["contact.friction=0.2", "contact.friction=0.4"]]
steps = "every=50,steps=1"
LIST

# begin ACTIVITY FOLDER: replaces the shell by the program at this activity.
begin() {
  case $1 in
    run) exec "$ballast" run vibrated_box_small "${small[@]}" --set scene.duration=0.4 \
        --output "$2/run" --packing-cache "$folder/packings" --continue ;;
    deposit) exec "$ballast" run vibrated_box_small "${small[@]}" --deposit-only \
        --output "$2/run" --packing-cache "$2/packings" ;;
    plan) exec "$ballast" plan "$folder/plan.toml" --jobs 2 --output "$2" ;;
    compare) exec "$ballast" compare known:bodies=20,contacts=40,count=4 pile:contacts=16 \
        --solvers pgs,nncg,prox_newton,interior_point --tolerances 1e-4,1e-8 --memory 0 \
        --output "$2" ;;
    paper) exec "$ballast" paper fig3 --jobs 1 --only 'motion*seed=1' \
        --set solver.max_iterations=5 --scene vibrated_box_small "${small[@]}" --results "$2" ;;
    collect) exec "$ballast" compare collect --list "$folder/collection.toml" --output "$2/c" ;;
    archive) exec "$ballast" paper archive --rows "$root/docs/measured/campaign_runs.csv" \
        --results "$2/none" --output "$2/archive" ;;
  esac
}

# columns FILE PATTERN: prints a table without the columns whose names match. A comma within
# quotation marks does not separate cells.
columns() {
  sed -E ':a; s/^(([^"]*"[^"]*")*[^"]*"[^",]*),/\1;/; ta' "$1" |
    awk -F, -v drop="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) keep[i] = $i !~ drop }
      { line = ""; for (i = 1; i <= NF; ++i) if (keep[i]) line = line "," $i; print line }'
}

# bits ACTIVITY FOLDER: prints checksums of all results that must be the same, one per line.
bits() {
  (cd "$2" && case $1 in
    compare) columns results.csv 'seconds|memory|runs|key|note' | md5sum ;;
    collect)
      find c/problems -type f | sort | xargs md5sum
      columns c/manifest.csv second | md5sum ;;
    archive) find archive -type f | sort | xargs md5sum ;;
    *)
      find . -name poses.bin -o -name checkpoint.bin -o -name 'packing-*.bin' \
        -o -name 'step_*.bin' | sort | xargs -r md5sum
      find . -name steps.csv | sort | while read -r table; do
        echo "$table $(columns "$table" '^seconds' | md5sum)"
      done
      [ "$1" != paper ] || md5sum report/data/*.csv ;;
  esac)
}

# fill_disks ACTIVITY: begins it on disks that are all too small; prints one line.
fill_disks() {
  local disk=$folder/disk log=$folder/$1.log needed level size code refused=0 went_on=0
  needed=$(du -sk "$folder/$1.whole" | cut -f1)
  mkdir -p "$disk"
  for ((level = 1; level <= disks; ++level)); do
    size=$((needed * level * 9 / (10 * disks) / 4 * 4 + 4))
    mount -t tmpfs -o "size=${size}k" ballast_disk "$disk"
    code=0
    (begin "$1" "$disk") >"$log" 2>&1 || code=$?
    if [ "$code" = 1 ] && grep -q "$disk/.*No space left" "$log"; then refused=$((refused + 1))
    else echo "$1, disk $level: exit code $code: $(tail -n 2 "$log")" >&2; fi
    mount -o remount,size=1g "$disk"
    if (begin "$1" "$disk") >"$log" 2>&1 &&
      bits "$1" "$disk" | diff -q - "$folder/$1.bits" >&2; then went_on=$((went_on + 1))
    else echo "$1, disk $level, does not go on: $(tail -n 2 "$log")" >&2; fi
    umount "$disk"
  done
  echo "| $1 | $needed kB | $disks | $refused | $went_on |"
  [ "$refused" = "$disks" ] && [ "$went_on" = "$disks" ]
}

now() { date +%s.%N; }
rows=() total=0 bad=0
share=$(((kills + $(wc -w <<<"$only") - 1) / $(wc -w <<<"$only")))
for activity in $only; do
  log=$folder/$activity.log whole=$folder/$activity.whole
  mkdir "$whole"
  # the packing of the run is deposited before its time is taken
  if [ "$activity" = run ]; then
    "$ballast" run vibrated_box_small "${small[@]}" --deposit-only --output "$whole/run" \
      --packing-cache "$folder/packings" >"$log" 2>&1
  fi
  start=$(now)
  (begin "$activity" "$whole") >"$log" 2>&1 || { tail -n 3 "$log"; echo "$activity fails"; exit 1; }
  seconds=$(awk -v a="$start" -v b="$(now)" 'BEGIN { print b - a }')
  bits "$activity" "$whole" >"$folder/$activity.bits"
  if [ "$disks" -gt 0 ]; then
    [ "$activity" != "${only%% *}" ] || printf '%s\n' \
      '| activity | needs | disks too small | refused | went on with the same bits |' \
      '|---|---|---|---|---|'
    fill_disks "$activity" || bad=$((bad + 1))
    continue
  fi
  done_count=0 killed=0 wrong=0 ended=0 round=0
  while [ "$killed" -lt "$share" ] && [ "$round" -lt 1000 ]; do
    round=$((round + 1)) there=$folder/$activity.$round longest=0.4
    mkdir "$there"
    while :; do
      after=$(awk -v r=$RANDOM -v t="$seconds" -v l="$longest" \
        'BEGIN { printf "%.3f", t * (0.02 + l * r / 32767) }')
      longest=$(awk -v l="$longest" 'BEGIN { print 1.05 * l }') # ends on a slower machine too
      code=0
      (begin "$activity" "$there") >"$log" 2>&1 &
      child=$!
      (sleep "$after"; kill -9 $child 2>/dev/null) &
      killer=$!
      wait $child 2>/dev/null || code=$?
      kill $killer 2>/dev/null || true
      wait $killer 2>/dev/null || true
      [ "$code" = 137 ] || break
      killed=$((killed + 1))
    done
    if [ "$code" != 0 ]; then
      ended=$((ended + 1))
      echo "$activity, round $round: exit code $code: $(tail -n 1 "$log")" >&2
    elif bits "$activity" "$there" | diff -q - "$folder/$activity.bits" >/dev/null; then
      done_count=$((done_count + 1))
    else
      wrong=$((wrong + 1))
      echo "$activity, round $round: other bits than undisturbed:" >&2
      bits "$activity" "$there" | diff - "$folder/$activity.bits" | head -n 6 >&2 || true
    fi
    rm -rf "$there"
  done
  total=$((total + killed)) bad=$((bad + wrong + ended))
  rows+=("$(printf '| %s | %.1f s | %d | %d | %d | %d | %d |' "$activity" "$seconds" "$killed" \
    "$round" "$done_count" "$wrong" "$ended")")
done

write_report() {
  echo "# $total kills"
  echo
  echo "\`$("$ballast" --version)\`, seed $seed, $(date -u +%Y-%m-%dT%H:%MZ), $(nproc) cores."
  echo
  echo "| activity | undisturbed | kills | ended | with the same bits | other bits | failed |"
  echo "|---|---|---|---|---|---|---|"
  printf '%s\n' "${rows[@]}"
}
[ "$disks" = 0 ] || exit $((bad > 0))
write_report
[ -z "$report" ] || write_report >"$report"
[ "$bad" = 0 ]
