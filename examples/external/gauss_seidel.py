#!/usr/bin/env python3
"""Projected Gauss-Seidel with numpy, as a backend of `ballast compare`:

    ballast compare known:contacts=50 --external numpy_gs="python3 gauss_seidel.py"
"""

import time

import numpy as np

from ballast_files import run


def sweep(problem, rows, weight, r):
    """One projection step at each contact, with the newest impulses of all others."""
    for c, (columns, block) in enumerate(rows):
        u = block @ r[columns] + problem.q[3 * c:3 * c + 3]
        x = r[3 * c:3 * c + 3] - weight[c] * u
        mu, slip = problem.mu[c], np.hypot(u[1], u[2])
        x[0] -= weight[c] * mu * slip
        # Onto the cone |x_T| <= mu x_N.
        tangent = np.hypot(x[1], x[2])
        if tangent > mu * x[0] or x[0] < 0:
            x[0] = max(0.0, (x[0] + mu * tangent) / (1 + mu * mu))
            x[1:] *= mu * x[0] / tangent if tangent > 0 else 0.0
        r[3 * c:3 * c + 3] = x


def solve(problem):
    begin = time.perf_counter()
    lambda_max = problem.lambda_max()
    if np.any(lambda_max <= 0):
        return 5, problem.start, 0, np.inf, []
    rows = []
    for c in range(len(problem.mu)):
        part = problem.W[3 * c:3 * c + 3]
        columns = np.unique(part.indices)
        rows.append((columns, part[:, columns].toarray()))
    r, history, iteration = problem.start.copy(), [], 0
    while True:
        is_solved, error = problem.is_solved(r, lambda_max)
        seconds = time.perf_counter() - begin
        history.append((iteration, seconds, error))
        if is_solved:
            return 0, r, iteration, error, history
        if seconds > problem.max_seconds:
            return 2, r, iteration, error, history
        if iteration >= problem.max_iterations:
            return 1, r, iteration, error, history
        for _ in range(10):
            sweep(problem, rows, 1 / lambda_max, r)
        iteration += 10


run(solve)
