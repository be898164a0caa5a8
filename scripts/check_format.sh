#!/usr/bin/env bash
# Checks that every source is as .clang-format makes it. To mend: scripts/check_format.sh --fix
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mode=(--dry-run -Werror)
[ "${1:-}" = --fix ] && mode=(-i)
echo "== clang-format"
git ls-files '*.cpp' '*.hpp' | xargs clang-format "${mode[@]}"
