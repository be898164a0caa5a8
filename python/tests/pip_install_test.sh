#!/usr/bin/env bash
# What `pip install .` leaves is whole: it is imported, solves and finds its scenes far from the
# source tree. Without network.
#
#   pip_install_test.sh PYTHON
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
"$1" -m pip --version >/dev/null 2>&1 || { echo "skipped: pip is not there"; exit 77; }
folder=$(mktemp -d /tmp/ballast_pip_XXXXXX)
trap 'rm -rf "$folder"' EXIT
"$1" -m pip install --no-index --no-deps --target "$folder/site" "$root" >"$folder/log" 2>&1 ||
  { cat "$folder/log"; exit 1; }
cd "$folder"
env -u BALLAST_SCENES PYTHONPATH="$folder/site" "$1" - <<'PY'
import os
import ballast
import numpy as np
assert ballast.__file__.startswith(os.getcwd()), ballast.__file__
problem = ballast.Problem.from_delassus(np.eye(3), [-1.0, 0.0, 0.0], [0.5])
assert ballast.solve(problem).solved
assert os.environ["BALLAST_SCENES"].startswith(os.getcwd())
ballast.Scene("drum")  # has a mesh
assert ballast.Scene("sliding_cube").step(3)["contacts"] > 0
PY
echo "pip install: ok"
