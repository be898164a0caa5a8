#!/usr/bin/env bash
# What a user of an installed Ballast does: installs into a folder, builds a project of his own on
# the library, and runs the program and its scenes from there and from the Debian package.
#
#   install_test.sh BUILD_FOLDER
set -euo pipefail
build=$(realpath "$1")
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(mktemp -d /tmp/ballast_install_XXXXXX)
trap 'rm -rf "$folder"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

# Moved after it was installed: nothing may remember a path.
cmake --install "$build" --prefix "$folder/first" >"$folder/log" 2>&1 ||
  { cat "$folder/log"; exit 1; }
mv "$folder/first" "$folder/moved"
grep -rl "$root" "$folder"/moved/lib*/cmake && fail "the CMake package names the source tree"
cd "$folder"
BALLAST_SCENES= moved/bin/ballast run zeno_ball --output run --no-report \
  --set scene.duration=0.01 >log 2>&1 || { cat log; fail "the installed program does not run"; }

# A project outside the tree.
cmake -S "$root/examples/library" -B example -DCMAKE_PREFIX_PATH="$folder/moved" \
  -DCMAKE_BUILD_TYPE=Release >log 2>&1 || { cat log; fail "find_package(Ballast)"; }
cmake --build example >log 2>&1 || { cat log; fail "the example does not build"; }
example/solve_two_boxes >said || fail "the example does not solve: $(cat said)"
[ "$(tr '\n' ' ' <said)" = "solved 1.000000 0.000000 0.000000 1.000000 -0.500000 0.000000 " ] ||
  fail "the example says: $(cat said)"
[ "$(example/time_a_solve two_boxes.hdf5 pgs 1e-8 3 | wc -l)" = 3 ] || fail "time_a_solve"
moved/bin/ballast solve two_boxes.hdf5 >log || fail "the program does not solve the library's file"
echo "installed: ok"
