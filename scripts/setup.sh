# Sourced by run.sh, test.sh and .ci/run: installs the Debian packages that are missing, configures
# and builds.

say() { printf '== %s\n' "$*"; }
die() { printf 'ballast: %s\n' "$*" >&2; exit 1; }

# Threaded BLAS makes supernodal factorisations slower, and results depend on it.
export OPENBLAS_NUM_THREADS=1

# missing_packages LIST...: the packages of these files that are not installed.
missing_packages() {
  local package
  grep -hv '^ *\(#\|$\)' "$@" | while read -r package; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' ||
      echo "$package"
  done
}

# install_packages LIST...
install_packages() {
  command -v dpkg-query >/dev/null || {
    say "not a Debian system: assuming that what apt-packages.txt lists is there"
    return
  }
  local missing as_root=()
  missing=$(missing_packages "$@")
  [ -z "$missing" ] && return
  [ "$(id -u)" = 0 ] || as_root=(sudo)
  missing=$(echo $missing)
  say "installing: $missing"
  # Waits for another apt-get, and for one that a killed script has left.
  as_root+=(env DEBIAN_FRONTEND=noninteractive)
  local apt=("${as_root[@]}" apt-get -qq -o DPkg::Lock::Timeout=600)
  "${apt[@]}" update || die "apt-get update failed"
  # shellcheck disable=SC2086
  set -- install -y --fix-broken --no-remove --no-install-recommends $missing
  "${apt[@]}" "$@" >/dev/null && return
  say "once more, after what an interrupted installation may have left half done"
  "${as_root[@]}" dpkg --configure -a >/dev/null && "${apt[@]}" "$@" >/dev/null ||
    die "could not install: $missing"
}

# show_progress LOG: copies the build's output into LOG and shows how far it is: on a terminal in
# one line that rewrites itself, elsewhere in a line for every tenth.
show_progress() {
  local line done_count all left last=0 begin=$SECONDS
  while IFS= read -r line; do
    printf '%s\n' "$line" >>"$1"
    [[ $line =~ ^\[([1-9][0-9]*)/([0-9]+)\] ]] || continue  # [0/2] comes first: nothing done yet
    done_count=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]}
    left=$(((SECONDS - begin) * (all - done_count) / done_count))
    if [ -t 1 ]; then
      printf '\r   %d of %d, about %d s left\033[K' "$done_count" "$all" "$left"
    elif [ $((10 * done_count / all)) -gt "$last" ]; then
      printf '   %d of %d, about %d s left\n' "$done_count" "$all" "$left"
    fi
    last=$((10 * done_count / all))
  done
  [ ! -t 1 ] || printf '\r\033[K'
}

interrupted() { printf '\ninterrupted; the same command goes on\n' >&2; exit "$1"; }

# ballast_setup PRESET TARGET [--no-install]
ballast_setup() {
  local preset=$1 target=$2 log begin=$SECONDS
  [ "${3:-}" = --no-install ] || install_packages "$root/apt-packages.txt"
  cd "$root" || exit 1
  log=$root/build-$preset.log
  say "building (preset $preset)"
  trap 'interrupted 130' INT
  trap 'interrupted 143' TERM
  cmake --preset "$preset" >"$log" 2>&1 &&
    cmake --build --preset "$preset" --target "$target" 2>&1 | show_progress "$log" || {
    tail -n 40 "$log" >&2
    die "the build failed; the whole log is build-$preset.log"
  }
  trap - INT TERM
  say "ready after $((SECONDS - begin)) s"
}
