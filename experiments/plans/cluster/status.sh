#!/bin/sh
# What became of job $1: running, success or failed. A job that Slurm has forgotten counts as
# failed: it is started again and goes on.
state=$(scontrol -o show job "$1" 2>/dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p')
[ -n "$state" ] || state=$(sacct -n -X -P -o State -j "$1" 2>/dev/null | head -n 1)
case "$state" in
  COMPLETED) echo success ;;
  PENDING|CONFIGURING|RUNNING|COMPLETING|SUSPENDED|RESIZING|REQUEUED|STAGE_OUT) echo running ;;
  *) echo failed ;;
esac
