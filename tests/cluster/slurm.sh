# shellcheck shell=bash
# A Slurm of this machine alone, in a folder of its own and on ports of its own; sourced by the tests. No containers, no
# systemd, no accounting. start_slurm FOLDER, then slurmctld, slurmd and munged run until stop_slurm, which the test
# calls from its EXIT trap.

export PATH=$PATH:/usr/sbin:/sbin

# Ends the test as skipped (ctest: SKIP_RETURN_CODE 77) where a command is missing.
need_commands() {
  local command
  for command in "$@"; do
    command -v "$command" >/dev/null && continue
    echo "SKIPPED: there is no $command; scripts/install-dependencies --with-workflows --with-slurm installs it"
    exit 77
  done
}

say() { echo "$SECONDS s: $*"; }

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# wait_for SECONDS WHAT COMMAND...: until the command succeeds.
wait_for() {
  local end=$((SECONDS + $1)) what=$2
  shift 2
  until "$@" >/dev/null 2>&1; do
    ((SECONDS < end)) || fail "$what did not happen"
    sleep .2
  done
}

free_ports() {
  python3 -c 'import socket
sockets = [socket.socket() for _ in range(2)]
for s in sockets: s.bind(("127.0.0.1", 0))
print(*(s.getsockname()[1] for s in sockets))'
}

write_slurm_conf() {
  local folder=$1 host user memory ports
  host=$(uname -n) user=$(id -un)
  memory=$(awk '/^MemTotal/ {print int($2 / 1024 * 0.9)}' /proc/meminfo)
  read -ra ports < <(free_ports)
  cat >"$folder/slurm.conf" <<CONF
ClusterName=vmesh
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmdPort=${ports[1]}
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1,sched_min_interval=100000
SlurmdParameters=config_overrides
MpiDefault=none
ReturnToService=2
JobRequeue=1
SlurmdTimeout=15
SlurmctldTimeout=15
KillWait=2
MinJobAge=600
CompleteWait=0
BatchStartTimeout=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 CoresPerSocket=2 RealMemory=$memory State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES State=UP
CONF
}

start_munge() {
  local folder=$1
  dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 status=none
  chmod 600 "$folder/munge.key"
  munged --force --key-file "$folder/munge.key" --socket "$folder/munge.socket" --pid-file "$folder/munged.pid" \
    --seed-file "$folder/munge.seed" --log-file "$folder/munged.log"
}

start_controller() { slurmctld -i -f "$SLURM_CONF"; }

start_node() { slurmd -f "$SLURM_CONF"; }

node_is_idle() { [[ "$(sinfo --noheader --format %T)" == idle ]]; }

# FOLDER: short, as its sockets' names may have 108 letters.
start_slurm() {
  slurm_folder=$1
  mkdir -p "$slurm_folder/state" "$slurm_folder/spool"
  chmod 755 "$slurm_folder"
  write_slurm_conf "$slurm_folder"
  export SLURM_CONF=$slurm_folder/slurm.conf
  start_munge "$slurm_folder"
  start_controller
  start_node
  wait_for 20 "a node that is ready" node_is_idle
}

daemon_pid() { cat "$slurm_folder/$1.pid" 2>/dev/null; }

# kill_daemon SIGNAL NAME: returns when it is gone.
kill_daemon() {
  local pid
  pid=$(daemon_pid "$2") && [[ -n "$pid" ]] || return 0
  kill "-$1" "$pid" 2>/dev/null || return 0
  while kill -0 "$pid" 2>/dev/null; do sleep .1; done
}

# The running jobs of the workflow in the folder RESULTS that make FILE, a regular expression.
jobs_of() {
  local number
  for number in $(squeue --noheader --states RUNNING --format %A); do
    ! grep -Eq "output: .*$2" "$1/log/slurm/$number.log" 2>/dev/null || echo "$number"
  done
}

runs() { [[ -n "$(jobs_of "$@")" ]]; }

requeued() { [[ "$(scontrol --oneliner show job "$1" | sed -E 's/.* Restarts=([0-9]+).*/\1/')" -ge 1 ]]; }

kill_job() {
  say "job $1 is killed"
  scancel --signal KILL --full "$1"
}

# With it the processes of job NUMBER. The node comes back once Slurm has given it up and has put the job back into the
# queue, after half a minute; were it back at once, Slurm would miss the job after two minutes only.
kill_node_and_job() {
  local pids
  say "the node and its job $1 are killed"
  mapfile -t pids < <(job_pids "$1")
  kill_daemon KILL slurmd
  kill -KILL "${pids[@]}" 2>/dev/null || true
  wait_for 60 "the end of the node's job" requeued "$1"
  start_node
}

kill_and_restart_controller() {
  say "the controller is killed"
  kill_daemon KILL slurmctld
  sleep 2
  start_controller
  wait_for 20 "an answer of the controller" scontrol ping
}

# The processes of job NUMBER, its slurmstepd first: Slurm's session of the job.
job_pids() {
  pgrep --full "slurmstepd: \[$1\." || true
  scontrol listpids "$1" 2>/dev/null | awk 'NR > 1 && $1 > 0 {print $1}'
}

stop_slurm() {
  [[ -n "${slurm_folder:-}" ]] || return 0
  scancel --quiet --user "$(id -un)" 2>/dev/null || true
  sleep 1
  local daemon
  for daemon in slurmd slurmctld munged; do kill_daemon TERM "$daemon"; done
}

# A folder for a test, in $work; it and what the test started go when the test ends. KEEP=1 keeps the folder.
begin_test() {
  work=$(mktemp -d /tmp/vmesh-XXXXXX)
  driver=
  trap end_test EXIT
  export CI=true  # Snakemake then asks for the state of jobs every second, not every ten
}

end_test() {
  local code=$?
  [[ -z "$driver" ]] || kill -- "-$driver" 2>/dev/null || true
  stop_slurm
  ((code == 0)) || tail -n 40 "$work"/*.log "$work"/slurm/*.log >&2 || true
  [[ -n "${KEEP:-}" ]] || rm -rf "$work"
  exit "$code"
}

# Runs a command in the background, what it says in LOG; its process group is $driver.
start_driver() {
  local log=$1
  shift
  setsid "$@" >"$log" 2>&1 &
  driver=$!
}

driver_ended() { ! kill -0 "$driver"; }

# Until the command ends, with 0.
finish_driver() {
  local code=0
  wait_for 300 "the end of the workflow" driver_ended
  wait "$driver" || code=$?
  driver=
  ((code == 0)) || fail "the workflow ended with $code"
}
