# shellcheck shell=bash Common to scripts/cohort/run and scripts/parts/run; sourced by them, with $root set.

# Prints the whole path of the command: $VMESH, that of this checkout, the one in the PATH, or one that is built now.
find_vmesh() {
  local built=$root/build/release/bin/vmesh
  if [[ -n "${VMESH:-}" ]]; then
    realpath "$VMESH"
  elif [[ -x "$built" ]]; then
    echo "$built"
  elif ! command -v vmesh; then
    "$root/scripts/install-dependencies" >&2
    "$root/scripts/build" release vmesh >&2
    echo "$built"
  fi
}

install_engine() {
  command -v snakemake >/dev/null || "$root/scripts/install-dependencies" --without-build --with-workflows
  if [[ "$profile" == slurm ]] && ! command -v sbatch >/dev/null; then
    echo "$0: there is no sbatch here; run on a machine that submits to the cluster" >&2
    exit 2
  fi
}

# run_snakemake SNAKEFILE RESULTS [OPTION...]: one at a time in a folder. A killed run leaves nothing locked: the lock
# belongs to a file that is open here and in all its processes on this machine.
run_snakemake() {
  local snakefile=$1 results=$2
  shift 2
  [[ "$profile" == */* ]] || profile=$root/scripts/engine/$profile
  [[ -f "$profile/config.yaml" ]] || {
    echo "$0: there is no $profile/config.yaml; --profile is local, slurm or a folder" >&2
    exit 2
  }
  exec 9>"$results/.lock"
  flock --nonblock 9 || {
    echo "$0: another run is at work in $results; wait for it or stop it" >&2
    exit 2
  }
  VMESH_JOB_NAME=vmesh-$(sha256sum <<<"$(uname -n) $results" | cut -c 1-12)
  export VMESH_JOB_NAME VMESH_PROGRESS=8
  # Jobs left behind by a killed run would do the same work twice.
  if command -v scancel >/dev/null && [[ "$profile" != */local ]]; then
    scancel --quiet --user "$(id -un)" --name "$VMESH_JOB_NAME" || true
  fi
  local command=(snakemake --snakefile "$snakefile" --directory "$results" --profile "$profile" --nolock "$@")
  if [[ " $* " =~ " -n "|" --dry-run " ]]; then
    "${command[@]}"
    return
  fi
  if [[ "$profile" == */local ]]; then  # what runs at a time fits into the memory
    command+=(--resources "mem_mb=$(awk '/^MemTotal/ {print int($2 / 1024 * 0.9)}' /proc/meminfo)")
  fi
  local log=$results/log/snakemake.log
  mkdir -p "$results/log"
  "${command[@]}" --log-handler-script "$root/scripts/engine/progress.py" 8>&2 2>"$log" || {
    local code=$?
    echo "$0: not everything finished; Snakemake's messages are in $log" >&2
    return "$code"
  }
}
