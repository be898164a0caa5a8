"""What Python costs: the same solves by the module and by a C++ program linked with the installed
library, the same steps by the module (a callback after each) and by `ballast bench step`. By turns,
on one core, each turn a new process; processor times, since other programs hardly enter these;
ratios of neighbouring turns, of which the median counts.

    overhead.py solve PROBLEM TIME_A_SOLVE [--solver pgs] [--tolerance 1e-3]
    overhead.py step SCENE BALLAST PACKINGS [--set KEY=VALUE ...]

TIME_A_SOLVE is built from examples/library. The module must be on PYTHONPATH.
"""

import argparse
import csv
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

SOLVE = """
import sys, time, ballast
problem = ballast.Problem.read(sys.argv[1])
for _ in range(int(sys.argv[4])):
    begin = time.process_time()
    answer = ballast.solve(problem, sys.argv[2], tolerance=float(sys.argv[3]))
    print(time.process_time() - begin)
    assert answer.solved
"""

STEP = """
import sys, time, ballast
scene = ballast.Scene(sys.argv[1], sys.argv[4:], packings=sys.argv[2])
times = [time.process_time()]
scene.step(int(sys.argv[3]), lambda scene, record: times.append(time.process_time()))
for begin, end in zip(times[1:], times[2:]):
    print(end - begin)
"""


def on_core(words, core):
    """The lines that a program prints, as numbers."""
    done = subprocess.run(["taskset", "-c", str(core), *words], check=True, text=True,
                          stdout=subprocess.PIPE)
    return [float(line) for line in done.stdout.split()]


def steps_of_the_bench(words, core):
    """Median processor seconds of a whole step in `ballast bench step`, which records nothing."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["taskset", "-c", str(core), *words, "--output", folder], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with open(pathlib.Path(folder, "step.csv"), encoding="utf-8") as file:
            rows = {(row["group"], row["name"]): row for row in csv.DictReader(file)}
    return [1e-3 * float(rows["1 thread, all", "step, CPU"]["median"])]


def compare(ours, theirs, rounds):
    """Turns of both; medians, and the median ratio with its range."""
    pairs = []
    for turn in range(rounds):
        order = (ours, theirs) if turn % 2 == 0 else (theirs, ours)
        times = {measure: statistics.median(measure()) for measure in order}
        pairs.append((times[ours], times[theirs]))
    ratios = sorted(a / b for a, b in pairs)
    print(f"Python {1e3 * statistics.median(a for a, _ in pairs):.3f} ms, "
          f"C++ {1e3 * statistics.median(b for _, b in pairs):.3f} ms, ratio "
          f"{statistics.median(ratios):.4f} ({ratios[0]:.4f} to {ratios[-1]:.4f}), "
          f"{rounds} turns each")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["solve", "step"])
    parser.add_argument("subject", help="PROBLEM or SCENE")
    parser.add_argument("program", help="TIME_A_SOLVE or BALLAST")
    parser.add_argument("packings", nargs="?", help="PACKINGS")
    parser.add_argument("--solver", default="pgs")
    parser.add_argument("--tolerance", default="1e-3")
    parser.add_argument("--solves", default="9", help="in a turn; their median counts")
    parser.add_argument("--steps", default="200")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--core", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=7)
    options = parser.parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if options.what == "solve":
        words = [options.subject, options.solver, options.tolerance, options.solves]
        compare(lambda: on_core([sys.executable, "-c", SOLVE, *words], options.core),
                lambda: on_core([options.program, *words], options.core), options.rounds)
    else:
        sets = [word for value in options.set for word in ("--set", value)]
        compare(lambda: on_core([sys.executable, "-c", STEP, options.subject, options.packings,
                                 options.steps, *options.set], options.core),
                lambda: steps_of_the_bench([options.program, "bench", "step", options.subject,
                                            "--steps", options.steps, "--no-plot",
                                            "--packing-cache", options.packings, *sets],
                                           options.core),
                options.rounds)


if __name__ == "__main__":
    main()
