"""Draws C = rise/X against X, X the right side of Eq. 3, from runs.csv beside this file."""
import csv, pathlib, sys
import matplotlib.pyplot as plt

table = list(csv.DictReader(open(pathlib.Path(__file__).with_name("runs.csv"))))
for stage, mark in zip(("frequency", "slowest", "force", "gravity", "mass"), "^^osD"):
    rows = [row for row in table if row["stage"] == stage and row["prefactor"]]
    plt.semilogx([1e3 * float(row["eq3"]) for row in rows],
                 [float(row["prefactor"]) for row in rows], mark, label=stage)
plt.xlabel("right side of Eq. 3 without C, X (mm)"), plt.ylabel("C"), plt.legend(), plt.ylim(0)
plt.savefig(sys.argv[1] if len(sys.argv) > 1 else "curve.png")
