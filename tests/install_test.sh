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
for scene in zeno_ball drum; do  # drum has a mesh
  BALLAST_SCENES= moved/bin/ballast run $scene --output run_$scene --no-report \
    --set scene.duration=0.01 >log 2>&1 || { cat log; fail "$scene does not run, installed"; }
done

# A project outside the tree.
cmake -G Ninja -S "$root/examples/library" -B example -DCMAKE_PREFIX_PATH="$folder/moved" \
  -DCMAKE_BUILD_TYPE=Release >log 2>&1 || { cat log; fail "find_package(Ballast)"; }
cmake --build example >log 2>&1 || { cat log; fail "the example does not build"; }
example/solve_two_boxes >said || fail "the example does not solve: $(cat said)"
[ "$(tr '\n' ' ' <said)" = "solved 1.000000 0.000000 0.000000 1.000000 -0.500000 0.000000 " ] ||
  fail "the example says: $(cat said)"
moved/bin/ballast solve two_boxes.hdf5 >log || fail "the program does not solve the library's file"
echo "installed: ok"

# The archive of the sources: the tree itself, without what was built.
cpack --config "$build/CPackSourceConfig.cmake" -B "$folder/sources" >log 2>&1 ||
  { cat log; fail "cpack of the sources"; }
tar -tzf sources/ballast-*-Source.tar.gz | cut -d/ -f2- >names
grep -qx CMakeLists.txt names || fail "the sources begin with $(head -1 names)"
grep -q '^build/' names && fail "the sources hold what was built"
echo "sources: ok"

# The Debian package, in a root that holds it and what it depends on, nothing else.
for tool in dpkg-shlibdeps file; do
  command -v $tool >log || { echo "packaged: skipped, there is no $tool"; exit; }
done
cpack --config "$build/CPackConfig.cmake" -B "$folder/deb" -D CPACK_COMPONENTS_ALL=program \
  >log 2>&1 || { cat log; fail "cpack"; }
clean=$folder/root
mkdir -p "$clean"/usr/{bin,lib,lib64,sbin} "$clean"/{etc,proc,tmp}
for name in bin lib lib64 sbin; do ln -s usr/$name "$clean/$name"; done
# The packages, and those that they need, of "a (>= 1) | b, c" each the first that is installed.
dpkg-query -W -f='${Package}\t${Depends}, ${Pre-Depends}\t${Provides}\n' | awk -F'\t' \
  -v wanted="$(dpkg-deb -f deb/ballast_*.deb Depends)" '
  function plain(name) { gsub(/\([^)]*\)|:any|[ ]/, "", name); return name }
  { needs[$1] = $2; split($3, names, ","); for (k in names) giver[plain(names[k])] = $1 }
  function take(list,   groups, names, g, k, name) {
    split(list, groups, ",")
    for (g in groups) {
      for (k = 1; k <= split(groups[g], names, "|"); ++k) {
        name = plain(names[k])
        if (!(name in needs)) name = giver[name]
        if (name in needs) break
      }
      if (!(name in needs) || name in taken) continue
      taken[name] = 1; print name; take(needs[name])
    }
  }
  END { take(wanted) }' >packages
xargs dpkg -L <packages | sort -u | grep -v -e /share/doc -e /share/man -e /share/locale |
  while read -r file; do if [ -L "$file" ] || [ -f "$file" ]; then echo "$file"; fi; done |
  tar -C / --no-recursion -cf - -T - 2>/dev/null | tar -C "$clean" --keep-directory-symlink -xf -
cp -a /etc/alternatives "$clean/etc/"  # libblas3 is there by a link that its package makes
find /usr/lib -type l -lname '/etc/alternatives/*' | tar -C / -cf - -T - 2>/dev/null |
  tar -C "$clean" --keep-directory-symlink -xf -
dpkg-deb -x deb/ballast_*.deb "$clean"
ldconfig -r "$clean"
# The sanitizer's options name a file that is not in there.
there=(env -u TSAN_OPTIONS unshare -rmpf --mount-proc="$clean/proc")
"${there[@]}" true 2>log || { echo "packaged: not run, no namespaces here: $(cat log)"; exit; }
"${there[@]}" chroot "$clean" /usr/bin/ballast run zeno_ball --output /tmp/run --no-report \
  --set scene.duration=0.01 >log 2>&1 ||
  { cat log; fail "the package does not run in a clean root"; }
# It can fail: without one of them it does not start.
rm "$clean"/usr/lib/*-linux-gnu/libqhull_r.so.*
"${there[@]}" chroot "$clean" /usr/bin/ballast --help >log 2>&1 && fail "the root is not clean"
echo "packaged: ok"
