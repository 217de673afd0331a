# Virtual environments for benchmarks beside other programs. To be sourced.

# at_least MINOR PYTHON: whether PYTHON runs, is 3.MINOR or newer and can make environments. A shim of pyenv may be in
# the PATH without being able to run.
at_least() {
  "$2" -c "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, $1))" >/dev/null 2>&1
}

# find_python MINOR CANDIDATE...: the first that is new enough.
find_python() {
  local minor=$1 candidate
  shift
  for candidate in "$@"; do
    if at_least "$minor" "$candidate"; then
      echo "$candidate"
      return
    fi
  done
  return 1
}

# make_environment PYTHON FOLDER REQUIREMENTS: makes or completes it; what was interrupted or is out of date is redone.
make_environment() {
  if cmp -s "$3" "$2/installed.txt"; then
    return
  fi
  echo "installing the packages of ${3##*/} into build/${2##*/}" >&2
  "$1" -m venv --clear "$2"
  "$2/bin/python" -m pip install --quiet --disable-pip-version-check -r "$3" >&2 || return 1
  cp "$3" "$2/installed.txt"
}
