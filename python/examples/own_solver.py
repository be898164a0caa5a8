"""A solver of one's own in the tables and figures of a comparison, beside all others:

    ballast compare known:contacts=50 --solvers pgs,nncg --external own="python3 own_solver.py"
"""
import time

import numpy as np

import ballast


def project(x, mu):
    """Onto the cone |x_T| <= mu x_N, contact by contact."""
    tangent = np.hypot(x[:, 1], x[:, 2])
    out = (tangent > mu * x[:, 0]) | (x[:, 0] < 0)
    normal = np.where(out, np.maximum(0, (x[:, 0] + mu * tangent) / (1 + mu**2)), x[:, 0])
    scale = np.where(out, mu * normal / np.maximum(tangent, 1e-300), 1.0)
    return np.column_stack([normal, x[:, 1] * scale, x[:, 2] * scale])


def projected_gradient(request):
    W, q, mu = request.problem.W, request.problem.q, request.problem.mu
    weight = 1 / abs(W).sum(axis=1).max()
    r, history, begin = request.start, [], time.perf_counter()
    for iteration in range(request.max_iterations + 1):
        if iteration % 20 == 0:
            error = ballast.judge(request.problem, r)["natural_map_rms"]
            seconds = time.perf_counter() - begin
            history.append([iteration, seconds, error])
            if error <= request.tolerance:
                break
            if seconds > request.max_seconds:
                return {"impulses": r, "status": "time_limit", "history": history}
        u = (W @ r.ravel()).reshape(-1, 3) + q
        u[:, 0] += mu * np.hypot(u[:, 1], u[:, 2])
        r = project(r - weight * u, mu)
    return {"impulses": r, "iterations": iteration, "history": history}


ballast.serve(projected_gradient)
