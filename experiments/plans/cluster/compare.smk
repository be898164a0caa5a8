# Written by `ballast compare --snakemake`: cases x backends as jobs. Snakemake 7.
#
#   snakemake -s Snakefile --profile slurm      on a cluster with Slurm, from this folder
#   snakemake -s Snakefile --cores 4            on this machine
#
# A job that dies is started again and goes on; the solve during which it died is then a row.

import json, os, shlex

with open(os.path.join(workflow.basedir, "jobs.json")) as file:
    PLAN = json.load(file)
DONE = os.path.join(PLAN["results"], "snakemake", "{job}.done")
LOG = os.path.join(PLAN["results"], "logs", "{job}.log")

def ballast(arguments):
    return f"cd {shlex.quote(PLAN['folder'])} && OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 " + shlex.join([PLAN["program"]] + arguments)

localrules: finished

rule finished:
    input: expand(DONE, job=PLAN["jobs"])
    params: command=ballast(PLAN["finish"])
    shell: "{params.command}"

rule part:
    output: touch(DONE)
    params: command=lambda wildcards: ballast(PLAN["jobs"][wildcards.job])
    log: LOG
    shell: "{params.command} >>{log} 2>&1"
