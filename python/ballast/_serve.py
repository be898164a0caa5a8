"""A solver written in Python as a backend of `ballast compare` (docs/manual/external.md)."""

from __future__ import annotations

import dataclasses
import sys
import time
from typing import Callable, Optional, Sequence, Union

import numpy as np

from . import _ballast
from ._problem import Problem, _require_real

_statuses = ["solved", "iteration_limit", "time_limit", "stalled", "failed", "unsupported",
             "out_of_memory"]


@dataclasses.dataclass(frozen=True)
class Request:
    """The request of a comparison to a solver."""

    problem: Problem
    start: np.ndarray  #: r to begin with [N s], (n, 3)
    tolerance: float  #: on the scaled natural map, rms over contacts [m/s]; 0: not asked
    fclib_tolerance: float  #: on Siconos' own measure; 0: not asked
    max_iterations: int
    max_seconds: float  #: may be infinite


def _answer(solver: Callable, problem: str, answer: str) -> None:
    asked = _ballast.Request.read(problem)
    request = Request(Problem(asked.problem), asked.start, asked.tolerance, asked.fclib_tolerance,
                      asked.max_iterations, asked.max_seconds)
    begin = time.perf_counter()
    reply = solver(request)
    seconds = time.perf_counter() - begin
    if not isinstance(reply, dict):
        reply = {"impulses": reply}
    unknown = set(reply) - {"impulses", "status", "iterations", "residual", "history"}
    if unknown:
        raise ValueError("the answer has no %s" % ", ".join(sorted(unknown)))
    status = reply.get("status", "solved")
    if status not in _statuses:
        raise ValueError("status %r: expected one of %s" % (status, ", ".join(_statuses)))
    _require_real(reply.get("impulses"), reply.get("history"))
    iterations = min(int(reply.get("iterations", 0)), asked.max_iterations)
    asked.answer(answer, _statuses.index(status), reply.get("impulses"), iterations,
                 float(reply.get("residual", 0.0)), seconds,
                 np.asarray(reply.get("history", []), dtype=float))


def serve(solver: Callable[[Request], Union[np.ndarray, dict]],
          arguments: Optional[Sequence[str]] = None) -> None:
    """Makes a function a backend: `ballast compare ... --external mine="python3 mine.py"`, where
    the last line of mine.py is ballast.serve(my_solver). The function takes a Request and returns
    r, (n, 3) or (3n), or a dict of impulses, status ("solved", "iteration_limit", ...), iterations,
    residual and history, (k, 3): iteration, seconds, scaled natural map [m/s]. arguments: what
    stands behind the script, PROBLEM ANSWER or --serve."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if len(words) == 2:
        _answer(solver, *words)
        return
    if words != ["--serve"]:
        raise SystemExit("expected PROBLEM ANSWER, or --serve")
    print("ready", flush=True)
    for line in sys.stdin:
        try:
            _answer(solver, *line.rstrip("\n").split("\t"))
            print("done", flush=True)
        except Exception as error:
            print("failed: %s" % " ".join(str(error).split()), flush=True)
