"""Rigid-body contact with friction: problems, solvers, their judge, and scenes to step.

    import ballast
    problem = ballast.Problem.from_delassus(W, q, mu)
    answer = ballast.solve(problem, tolerance=1e-8)

M (v - v_free) = H' r,  u = H v + w,  W = H M^-1 H',  q = H v_free + w, and Coulomb's law with
Signorini's between r and u at every contact. Three rows per contact: normal, two tangents. r is the
impulse [N s] on the second body, u its relative velocity [m/s]; u_N > 0 opens.
"""

from __future__ import annotations

import dataclasses
import functools
import os
import pathlib
import sys
from typing import Optional, Sequence

try:
    from . import _ballast
except ImportError as error:
    _built = sorted(file.name for file in pathlib.Path(__file__).parent.glob("_ballast*.so"))
    raise ImportError(f"{error}: ballast was built as {', '.join(_built) or 'nothing'}, "
                      f"and this is Python {sys.version.split()[0]}, {sys.executable}") from error

import numpy as np

from ._ballast import (Error, InvalidProblem, MissingSolver, Scene as _Scene, UnknownSolver,
                       UnsupportedProblem, scenes, solvers)

from ._files import Captured, Record, rows
from ._problem import Path, Problem, _require_real
from ._serve import Request, serve

__all__ = ["Problem", "Answer", "Scene", "Captured", "Record", "Request", "solve", "judge", "rows",
           "serve", "solvers", "scenes", "Error", "InvalidProblem", "MissingSolver",
           "UnknownSolver", "UnsupportedProblem"]

# An installed module brings the scenes along.
_scene_folder = pathlib.Path(__file__).parent / "scenes"
if _scene_folder.is_dir():
    os.environ.setdefault("BALLAST_SCENES", str(_scene_folder))


@dataclasses.dataclass(frozen=True)
class Answer:
    """What a solver made of a problem, and what the judge found."""

    problem: Problem
    impulses: np.ndarray  #: r [N s], (n, 3)
    history: np.ndarray  #: iteration, seconds, scaled natural map rms [m/s]; (k, 3)
    verdict: str  #: "solved", "unsolved", "denied" or "no_solution"
    words: str  #: the verdict in one line
    reason: str  #: why the solver stopped
    iterations: int
    own_residual: float  #: the solver's own; never evidence
    seconds: float  #: of the method, without the judge
    error: dict  #: the judge's measures, as judge() returns them

    @property
    def solved(self) -> bool:
        """The solver says so and the judge agrees on every part of the law."""
        return self.verdict == "solved"

    @functools.cached_property
    def velocities(self) -> np.ndarray:
        """u [m/s], (n, 3)."""
        return _ballast.velocities(self.problem._core, self.impulses)

    @functools.cached_property
    def body_velocities(self) -> np.ndarray:
        """v [m/s, rad/s], (d); empty without bodies."""
        return _ballast.body_velocities(self.problem._core, self.impulses)


def solve(problem: Problem, solver: str = "auto", *, tolerance: float = 1e-8,
          absolute: bool = False, start: Optional[np.ndarray] = None,
          max_iterations: int = 10000, max_seconds: float = 1e30) -> Answer:
    """Solves with one of solvers(). The tolerance is on the scaled natural map, rms over contacts,
    over the rms of q; with absolute=True it is in m/s. start: r [N s], (n, 3) or (3n). Other
    threads run meanwhile."""
    _require_real(start)
    return Answer(problem, **_ballast.solve(problem._core, solver, float(tolerance), absolute,
                                            start, max_iterations, float(max_seconds)))


def judge(problem: Problem, r: np.ndarray) -> dict:
    """Every measure of impulses r [N s], (n, 3) or (3n), from r alone: natural_map_rms and _max
    [m/s], worst_contact, velocity_scale [m/s], fclib (what Siconos prints), approach_rms, cone_rms,
    complementarity_rms [m/s], and more; the program's `solve --help` says what each means."""
    _require_real(r)
    return _ballast.judge(problem._core, r)


class Scene(_Scene):
    """A scene of bodies and walls under way: a name of scenes(), or a TOML file. Grains are
    deposited first, which may take minutes, or taken from the folder `packings`, where they are
    kept: the same that `ballast run` keeps beside its results.

    positions, velocities (n, 3), rotations (n, 4: x, y, z, w) and spins (n, 3, body frame) are the
    memory that is stepped: nothing is copied, and what is written there is the state."""

    def __init__(self, name: Path, overrides: Sequence[str] = (),
                 packings: Path = "results/packings"):
        if isinstance(overrides, str):
            raise TypeError(f"overrides: expected a list of settings, got {overrides!r}")
        super().__init__(os.fspath(name), list(overrides), os.fspath(packings))

    @property
    def problem(self) -> Problem:
        """The friction problem of the last step, a copy."""
        return Problem(self.last_problem())
