#!/usr/bin/env bash
# Every source is what .clang-format makes of it. Mend with: scripts/check_format.sh --fix
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mode=(--dry-run -Werror)
[ "${1:-}" = --fix ] && mode=(-i)
echo "== clang-format"
git ls-files '*.cpp' '*.hpp' | xargs clang-format "${mode[@]}"
