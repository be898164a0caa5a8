#!/usr/bin/env python3
"""The conic form with SciPy: OSQP's splitting (ADMM) on min r.Wr/2 + r.(q + s n) over the cones,
one sparse factor of W + rho, and s = mu |u_T| anew every 25 iterations, which makes Coulomb's law
of the convex one.

    ballast compare known:contacts=50 --external scipy_admm="python3 conic_scipy.py"
"""

import time

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu

from ballast_files import project, run


def solve(problem):
    begin = time.perf_counter()
    size, contacts = len(problem.q), len(problem.mu)
    lambda_max = problem.lambda_max()
    if np.any(lambda_max <= 0):
        return 5, problem.start, 0, np.inf, []
    # Impulses in units in which every contact has the largest eigenvalue 1.
    unit = np.repeat(1 / np.sqrt(lambda_max), 3)
    scale = sparse.diags(unit)
    W = (scale @ problem.W @ scale).tocsc()
    z, y = problem.start / unit, np.zeros(size)
    history, iteration, rho, factor = [], 0, 0.1, None
    while True:
        r = z * unit
        is_solved, error = problem.is_solved(r, lambda_max)
        seconds = time.perf_counter() - begin
        history.append((iteration, seconds, error))
        if is_solved or seconds > problem.max_seconds or iteration >= problem.max_iterations:
            status = 0 if is_solved else 2 if seconds > problem.max_seconds else 1
            return status, r, iteration, error, history
        if factor is None:
            factor = splu(W + rho * sparse.identity(size, format="csc"))
        u = (problem.W @ r + problem.q).reshape(contacts, 3)
        shifted = problem.q.reshape(contacts, 3).copy()
        shifted[:, 0] += problem.mu * np.hypot(u[:, 1], u[:, 2])
        for _ in range(25):
            x = factor.solve(rho * (z - y) - unit * shifted.ravel())
            z_old = z
            z = project((x + y).reshape(contacts, 3), problem.mu).ravel()
            y += x - z
        iteration += 25
        # rho keeps the two residuals at one size, as OSQP does.
        primal, dual = np.linalg.norm(x - z), rho * np.linalg.norm(z - z_old)
        ratio = np.sqrt(max(primal, 1e-30) / max(dual, 1e-30))
        if not 0.2 < ratio < 5:
            ratio = min(max(ratio, 0.1), 10)
            rho, y, factor = rho * ratio, y / ratio, None


run(solve)
