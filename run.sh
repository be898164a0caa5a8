#!/usr/bin/env bash
# Installs what is missing, builds, and runs the paper's experiment: 1200 polyhedral grains in a
# box, driven at 5 Hz for 1 s.
#
#   ./run.sh [--no-install] [arguments of `ballast run`, default: vibrated_box]
#
# The results are in results/<scene> of the folder where you stand: report.html is the page to open.
# A run that was stopped goes on when the same command is given again; a finished one stays.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/scripts/setup.sh"

install=
if [ "${1:-}" = --no-install ]; then install=--no-install; shift; fi
if [ "${1:-}" = --help ] || [ "${1:-}" = -h ]; then
  sed -n '2,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi
caller=$PWD
ballast_setup default ballast $install
cd "$caller"

[ $# -gt 0 ] || set -- vibrated_box
# a run that was stopped, in its deposit too, goes on; a finished one is not done again
case " $* " in
  *" --continue "* | *" --overwrite "* | *" --help "* | *" -h "*) ;;
  *) set -- "$@" --continue ;;
esac
# the same bits on one thread; a third finds nothing to do in 1200 grains
case " $* " in
  *" --threads "* | *" --threads="*) ;;
  *) [ "$(nproc)" -lt 2 ] || set -- "$@" --threads 2 ;;
esac
exec "$root/build/default/bin/ballast" run "$@"
