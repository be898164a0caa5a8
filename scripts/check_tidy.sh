#!/usr/bin/env bash
# clang-tidy with the checks of .clang-tidy, over the batches in which the sources are compiled.
# Tests are left out: clang 14 does not take all the C++20 that they are written in.
#
#   scripts/check_tidy.sh [words of file names]: only batches whose path holds one of the words
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
echo "== clang-tidy"
cmake --preset tidy >build-tidy.log 2>&1 || { cat build-tidy.log; exit 1; }
cmake --build build/tidy --target ballast_build_info >>build-tidy.log 2>&1
rooms='(platform|geometry|problems|solvers|experiments)'
words=$(IFS='|'; echo "${*:-.}")
grep -o '"file": "[^"]*"' build/tidy/compile_commands.json | cut -d'"' -f4 |
  grep -v -e /precompiled/ -e '/build/tidy/[^U]*$' -e /tests/ | grep -E "$words" | sort |
  xargs -P "$(nproc)" -n 1 \
    clang-tidy -p build/tidy --quiet --header-filter="^$root/$rooms/" 2>build/tidy/clang-tidy.err
