"""The two files of Ballast's protocol for solvers in other languages, docs/manual/external.md."""

import sys
import time

import h5py
import numpy as np
import scipy.sparse as sparse


class Problem:
    """W [1/kg], q [m/s], mu, start [N s]; three rows (normal, tangents) per contact."""

    def __init__(self, path):
        with h5py.File(path, "r") as file:
            local, asked = file["fclib_local"], file["ballast_request"]
            if asked["protocol"][0] != 1:
                raise ValueError("protocol %d is not known" % asked["protocol"][0])
            w = local["W"]
            form = sparse.csc_matrix if w["nz"][0] == -1 else sparse.csr_matrix
            shape = w["m"][0], w["n"][0]
            self.W = form((w["x"][:], w["i"][:], w["p"][:]), shape).tocsr()
            self.q, self.mu = local["vectors/q"][:], local["vectors/mu"][:]
            self.start = asked["start"][:]
            self.id = asked["id"][0]
            self.tolerance = asked["tolerance"][0]  # rms of the scaled natural map [m/s]; 0: none
            self.fclib_tolerance = asked["fclib_tolerance"][0]  # what Siconos prints; 0: none
            self.max_seconds = asked["max_seconds"][0]
            self.max_iterations = asked["max_iterations"][0]

    def lambda_max(self):
        """Largest eigenvalue of each contact's block of W [1/kg]."""
        blocks = np.stack([self.W[3 * c:3 * c + 3, 3 * c:3 * c + 3].toarray()
                           for c in range(len(self.mu))])
        return np.linalg.eigvalsh(blocks)[:, -1]

    def is_solved(self, r, lambda_max):
        """The measure that was asked for is reached; beside it the natural map, rms [m/s]."""
        u = (self.W @ r + self.q).reshape(-1, 3)
        u[:, 0] += self.mu * np.hypot(u[:, 1], u[:, 2])
        r = r.reshape(-1, 3)
        scaled = lambda_max[:, None] * (r - project(r - u / lambda_max[:, None], self.mu))
        rms = np.sqrt(np.mean(np.sum(scaled**2, axis=1)))
        if self.fclib_tolerance == 0:
            return rms <= self.tolerance, rms
        u0 = (self.W @ r.ravel() + self.q)
        size = max(np.linalg.norm(self.q), np.linalg.norm(r), np.linalg.norm(u0))
        return np.linalg.norm(r - project(r - u, self.mu)) <= self.fclib_tolerance * size, rms


def project(x, mu):
    """Onto the friction cones |x_T| <= mu x_N; x: contacts x 3."""
    tangent = np.hypot(x[:, 1], x[:, 2])
    normal = np.where((tangent <= mu * x[:, 0]) & (x[:, 0] >= 0), x[:, 0],
                      np.maximum(0, x[:, 0] + mu * tangent) / (1 + mu**2))
    slide = np.where(tangent > mu * normal, mu * normal / np.where(tangent > 0, tangent, 1), 1)
    return np.column_stack([normal, slide * x[:, 1], slide * x[:, 2]])


def write_answer(path, problem, status, r, iterations, residual, seconds, history):
    """status: 0 solved, 1 iteration limit, 2 time limit, 3 stalled, 5 cannot take the problem."""
    with h5py.File(path, "w") as file:
        answer = file.create_group("ballast_answer")
        for name, value in [("protocol", 1), ("id", problem.id), ("status", status),
                            ("iterations", iterations), ("residual", residual),
                            ("seconds", seconds)]:
            answer[name] = [value]
        answer["r"] = r
        answer["history"] = np.array(history, dtype=float).reshape(-1, 3)


def run(solve):
    """solve(problem) -> status, r, iterations, residual, history; the words of the command line."""
    def work(problem_path, answer_path):
        problem = Problem(problem_path)
        begin = time.perf_counter()
        status, r, iterations, residual, history = solve(problem)
        seconds = time.perf_counter() - begin
        write_answer(answer_path, problem, status, r, iterations, residual, seconds, history)

    if sys.argv[1:] != ["--serve"]:
        return work(*sys.argv[1:])
    print("ready", flush=True)
    for line in sys.stdin:
        try:
            work(*line.rstrip("\n").split("\t"))
            print("done", flush=True)
        except Exception as error:
            print("failed: %s" % " ".join(str(error).split()), flush=True)
