#!/usr/bin/env bash
# Runs clang-tidy with the checks of .clang-tidy. Headers cost most of its time, so four large
# batches hold the sources, without tests: clang 14 does not take all the C++20 that these use.
#
#   scripts/check_tidy.sh [words of file names]: only batches of a room that holds one of the words
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
echo "== clang-tidy"
cmake --preset tidy >build-tidy.log 2>&1 || { cat build-tidy.log; exit 1; }
cmake --build build/tidy --target ballast_build_info >>build-tidy.log 2>&1
rooms='(platform|geometry|problems|solvers|experiments)'
words=$(IFS='|'; echo "${*:-.}")
commands=build/tidy/compile_commands.json
flags=$(grep -o -E -e '-(I|D|isystem )[^" ]+' -e '-std=[^" ]+' "$commands" | sort -u)
sources=$(grep -o '"file": "[^"]*"' "$commands" | cut -d'"' -f4 | grep -E "$words" | sort |
  grep -v -e /precompiled/ -e '/build/tidy/[^U]*$' -e /tests/)

# batches: writes the batches, and prints them and the sources with flags of their own
batches() {
  local place=0 source part
  rm -f build/tidy/part_*.cpp
  while read -r source; do
    case $source in
      *build/tidy/experiments/*) part=experiments_$((place++ % 2)) ;;
      *build/tidy/solvers/*) part=solvers ;;
      *build/tidy/*) part=lower_rooms ;;
      *) echo "$source"; continue ;;
    esac
    echo "#include \"$source\"" >>"build/tidy/part_$part.cpp"
  done <<<"$sources"
  find build/tidy -maxdepth 1 -name 'part_*.cpp'
}

# check_one SOURCE: with the common flags, or with those of its own command
check_one() {
  case $1 in
    build/tidy/*) clang-tidy --quiet --header-filter="^$root/$rooms/" "$1" -- -O2 $flags ;;
    *) clang-tidy --quiet --header-filter="^$root/$rooms/" "$1" -p build/tidy ;;
  esac
}
export -f check_one
export root rooms flags
batches | xargs -P "$(nproc)" -I{} bash -c 'check_one "$1"' check_one {} \
  2>build/tidy/clang-tidy.err
