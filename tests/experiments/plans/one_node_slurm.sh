# Sourced by the tests that need a cluster: a Slurm of one node, that the test starts and ends.
#
# Gives $ballast, $folder (temporary), start_slurm, run_and_kill, fail, and `children` that are ended at the end.
# Needs munge, slurmctld, slurmd, slurm-client and snakemake (apt-packages-cluster.txt) and root, whose daemons they are; without
# them the test is skipped. Nothing of an installed Slurm is used or touched: configuration, keys, sockets and state are in the
# temporary folder, the ports are unusual.
set -uo pipefail

ballast=$(realpath "$1")
skip() { echo "SKIPPED: $*"; exit 77; }
fail() { echo "FAILED: $*"; exit 1; }

for program in munged slurmctld slurmd sbatch scontrol sinfo scancel snakemake; do
  PATH=$PATH:/usr/sbin command -v "$program" >/dev/null || skip "$program is missing (packages: apt-packages-cluster.txt)"
done
case $(snakemake --version) in 7.*) ;; *) skip "the profile is for Snakemake 7, this is $(snakemake --version)" ;; esac
[ "$(id -u)" = 0 ] || skip "a Slurm of one's own needs root"
PATH=$PATH:/usr/sbin

folder=$(mktemp -d /tmp/ballast_slurm_XXXXXX)
chmod 755 "$folder"
children=()
finish() {
  [ -n "${snakemake_id:-}" ] && kill "$snakemake_id" 2>/dev/null
  scancel --user=root 2>/dev/null  # of the Slurm that SLURM_CONF names: ours
  for child in "${children[@]}"; do kill "$child" 2>/dev/null; done
  for child in "${children[@]}"; do wait "$child" 2>/dev/null; done
  [ -n "${KEEP:-}" ] && echo "kept: $folder" || rm -rf "$folder"
}
trap finish EXIT

# --- one node ---------------------------------------------------------------------------------------------------------------------
start_slurm() {
  local host port=$((20000 + $$ % 20000)) munge=$folder/munge
  host=$(hostname -s)
  mkdir "$munge" "$folder/state" "$folder/spool" "$folder/log"
  head -c 64 /dev/urandom >"$munge/key"
  chmod 600 "$munge/key"
  cat >"$folder/slurm.conf" <<END
ClusterName=ballast
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$munge/socket
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=2000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
  export SLURM_CONF=$folder/slurm.conf
  munged --foreground --force --key-file="$munge/key" --socket="$munge/socket" --pid-file="$munge/pid" --log-file="$munge/log" \
    --seed-file="$munge/seed" >"$folder/log/munged" 2>&1 &
  children+=($!)
  for _ in $(seq 50); do [ -S "$munge/socket" ] && break; sleep 0.1; done
  slurmctld -D >"$folder/log/slurmctld" 2>&1 &
  children+=($!)
  slurmd -D -N "$host" >"$folder/log/slurmd" 2>&1 &
  children+=($!)
  for _ in $(seq 100); do
    [ "$(sinfo -h -o %t 2>/dev/null)" = idle ] && return
    sleep 0.2
  done
  tail -n 5 "$folder"/log/* | cat
  skip "Slurm cannot be started here: its last words are above"
}

# run_and_kill KILL WHERE: Snakemake with the profile in this folder, to its end. Meanwhile the function KILL looks for a worker
# WHERE, kills it and prints who it was: $killed. Slurm has made $jobs jobs, that one among them.
run_and_kill() {
  # With CI Snakemake looks after its jobs every second, and not every ten.
  (CI=true HOME=$folder exec snakemake -s Snakefile --profile slurm >"$folder/log/snakemake" 2>&1) &
  snakemake_id=$!
  killed=$("$1")
  wait "$snakemake_id" || { cat "$folder/log/snakemake"; fail "snakemake"; }
  snakemake_id=
  [ -n "$killed" ] || fail "no worker was found $2"
  jobs=$(find slurm/jobs -name '*.log' | wc -l)
}
