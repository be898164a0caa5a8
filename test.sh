#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#
#   ./test.sh [--no-install] [arguments of ctest]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/scripts/setup.sh"

install=
if [ "${1:-}" = --no-install ]; then install=--no-install; shift; fi
if [ "${1:-}" = --help ] || [ "${1:-}" = -h ]; then
  sed -n '2,4s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi
ballast_setup default all $install
say "testing"
# One more than there are cores: some tests wait, for a child, a clock or a browser.
exec ctest --preset default -j "$(($(nproc) + 1))" "$@"
