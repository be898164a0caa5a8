# Sourced by run.sh and test.sh: installs the Debian packages that are missing, configures and builds.
# Usage: ballast_setup PRESET TARGET [--no-install]

say() { printf '== %s\n' "$*"; }
die() { printf 'ballast: %s\n' "$*" >&2; exit 1; }

# Threaded BLAS makes supernodal factorisations slower, and results depend on it.
export OPENBLAS_NUM_THREADS=1

missing_packages() {
  local package
  grep -v '^ *\(#\|$\)' "$root/apt-packages.txt" | while read -r package; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || echo "$package"
  done
}

install_packages() {
  command -v dpkg-query >/dev/null || { say "not a Debian system: assuming that what apt-packages.txt lists is there"; return; }
  local missing as_root=()
  missing=$(missing_packages)
  [ -z "$missing" ] && return
  [ "$(id -u)" = 0 ] || as_root=(sudo)
  say "installing:" $missing
  "${as_root[@]}" apt-get update -qq || die "apt-get update failed"
  # shellcheck disable=SC2086
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends $missing >/dev/null ||
    die "could not install: $missing"
}

ballast_setup() {
  local preset=$1 target=$2
  [ "${3:-}" = --no-install ] || install_packages
  cd "$root" || exit 1
  say "building (preset $preset)"
  cmake --preset "$preset" >"$root/build-$preset.log" 2>&1 && cmake --build --preset "$preset" --target "$target" >>"$root/build-$preset.log" 2>&1 || {
    tail -n 40 "$root/build-$preset.log" >&2
    die "the build failed; the whole log is build-$preset.log"
  }
}
