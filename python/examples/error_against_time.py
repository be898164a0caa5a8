"""Error against time of some solvers on one problem, as text; matplotlib draws it where it is."""
import sys

import numpy as np

import ballast

# A chain of grains between walls: every contact shares a body with the next.
n = 40
rng = np.random.default_rng(1)
H = np.zeros((3 * (n + 1), 3 * n))
for c in range(n + 1):
    for k in range(3):
        if c < n:
            H[3 * c + k, 3 * c + k] = 1.0
        if c > 0:
            H[3 * c + k, 3 * (c - 1) + k] = -1.0
v_free = rng.normal(size=3 * n)
problem = ballast.Problem.from_bodies(np.eye(3 * n), H, mu=np.full(n + 1, 0.4), v_free=v_free)
curves = {}
for solver in ["pgs", "nncg", "auto"]:
    answer = ballast.solve(problem, solver, tolerance=1e-8)
    curves[solver] = answer.history
    print("%-5s %-8s %5d iterations  error %.1e m/s" % (
        solver, answer.verdict, answer.iterations, answer.error["natural_map_rms"]))
if len(sys.argv) > 1:
    import matplotlib.pyplot as plot
    for solver, history in curves.items():
        plot.loglog(history[1:, 1], history[1:, 2], label=solver)
    plot.xlabel("time [s]"), plot.ylabel("error [m/s]"), plot.legend()
    plot.savefig(sys.argv[1])
