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
import os
from typing import Any, Callable, Optional, Sequence, Union

import numpy as np
import scipy.sparse as sparse

from . import _ballast
from ._ballast import (Error, InvalidProblem, MissingSolver, Scene as _Scene, UnknownSolver,
                       UnsupportedProblem, scenes, solvers)

__all__ = ["Problem", "Answer", "Scene", "solve", "judge", "solvers", "scenes", "Error",
           "InvalidProblem", "MissingSolver", "UnknownSolver", "UnsupportedProblem"]

Path = Union[str, "os.PathLike[str]"]


class Problem:
    """A friction problem. Made by from_delassus, from_bodies or read; it does not change."""

    def __init__(self, core: _ballast.Problem):
        self._core = core

    @classmethod
    def from_delassus(cls, W: Any, q: np.ndarray, mu: np.ndarray) -> "Problem":
        """From W [1/kg], dense or sparse, (3n, 3n), positive semidefinite; q [m/s], (3n) or (n, 3);
        mu, (n). Raises ValueError and InvalidProblem, which names the entry."""
        W = sparse.csr_matrix(W)
        W.sum_duplicates()
        return cls(_ballast.Problem.from_delassus(W.data, W.indices, W.indptr, q, mu))

    @classmethod
    def from_bodies(cls, M: Any, H: Any, mu: np.ndarray, v_free: Optional[np.ndarray] = None,
                    f: Optional[np.ndarray] = None, w: Optional[np.ndarray] = None) -> "Problem":
        """From M [kg, kg m^2], (d, d), symmetric positive definite; H, (3n, d), with u = H v + w;
        mu, (n); v_free [m/s, rad/s], (d), or f = M v_free; w [m/s], (3n), zero if left out."""
        M = sparse.csc_matrix(M)
        transposed = sparse.csc_matrix(sparse.csr_matrix(H).T)
        if (v_free is None) == (f is None):
            raise ValueError("expected one of v_free and f")
        if v_free is not None:
            f = M @ np.asarray(v_free, dtype=float).ravel()
        if w is None:
            w = np.zeros(3 * len(mu))
        parts = [(a.data, a.indices, a.indptr) for a in (M, transposed)]
        return cls(_ballast.Problem.from_bodies(*parts, f, w, mu))

    @classmethod
    def read(cls, file: Path) -> "Problem":
        """A stored problem: FCLIB .hdf5, Siconos .dat, captured by a run."""
        return cls(_ballast.Problem.read(os.fspath(file)))

    def write(self, file: Path) -> None:
        """As FCLIB's HDF5: by its bodies where these are known, else W and q."""
        self._core.write(os.fspath(file))

    @property
    def W(self) -> sparse.csr_matrix:
        """The Delassus matrix [1/kg], (3n, 3n): built where only bodies are known."""
        data, indices, pointers = self._core.delassus()
        size = len(pointers) - 1
        return sparse.csr_matrix((data, indices, pointers), (size, size))

    @property
    def q(self) -> np.ndarray:
        """Relative velocities without impulses [m/s], (n, 3)."""
        return self._core.q

    @property
    def mu(self) -> np.ndarray:
        """Friction coefficients, (n)."""
        return self._core.mu

    @property
    def has_bodies(self) -> bool:
        """M and H are known, not only W."""
        return self._core.has_bodies

    def __len__(self) -> int:
        return self._core.contact_count


@dataclasses.dataclass(frozen=True)
class Answer:
    """What a solver made of a problem, and what the judge found."""

    impulses: np.ndarray  #: r [N s], (n, 3)
    velocities: np.ndarray  #: u [m/s], (n, 3)
    body_velocities: np.ndarray  #: v [m/s, rad/s], (d); empty without bodies
    history: np.ndarray  #: iteration, seconds, scaled natural map rms [m/s]; (k, 3)
    verdict: str  #: "solved", "unsolved", "denied" or "no_solution"
    words: str  #: the verdict in one line
    reason: str  #: why the solver stopped
    iterations: int
    own_residual: float  #: the solver's own; never evidence
    seconds: float  #: of the method, judging apart
    error: dict  #: the judge's measures, as judge() returns them

    @property
    def solved(self) -> bool:
        """The solver says so and the judge agrees on every part of the law."""
        return self.verdict == "solved"


def solve(problem: Problem, solver: str = "auto", *, tolerance: float = 1e-8,
          absolute: bool = False, start: Optional[np.ndarray] = None,
          max_iterations: int = 10000, max_seconds: float = 1e30) -> Answer:
    """Solves with one of solvers(). The tolerance is on the scaled natural map, rms over contacts,
    over the rms of q; with absolute=True it is in m/s. start: r [N s], (n, 3) or (3n). Other
    threads run meanwhile."""
    return Answer(**_ballast.solve(problem._core, solver, float(tolerance), absolute, start,
                                   max_iterations, float(max_seconds)))


def judge(problem: Problem, r: np.ndarray) -> dict:
    """Every measure of impulses r [N s], (n, 3) or (3n), from r alone: natural_map_rms and _max
    [m/s], worst_contact, velocity_scale [m/s], fclib (what Siconos prints), approach_rms, cone_rms,
    complementarity_rms [m/s], and more; the program's `solve --help` says what each means."""
    return _ballast.judge(problem._core, r)


class Scene:
    """A scene of bodies and walls under way: a name of scenes(), or a TOML file.

    positions, velocities (n, 3), rotations (n, 4: x, y, z, w) and spins (n, 3, body frame) are the
    memory that is stepped: nothing is copied, and what is written there is the state."""

    def __init__(self, name: Path, overrides: Sequence[str] = ()):
        self._core = _Scene(os.fspath(name), list(overrides))

    def step(self, count: int = 1,
             callback: Optional[Callable[["Scene", dict], Any]] = None) -> dict:
        """Steps so often; the last step's record: a number for each column of a run's record.
        callback(scene, record) comes after each step, and ends the stepping when it is False."""
        if callback is None:
            return self._core.step(count, None)
        return self._core.step(count, lambda _, record: callback(self, record))

    @property
    def positions(self) -> np.ndarray:
        """Centres of mass [m], (n, 3)."""
        return self._core.positions

    @property
    def rotations(self) -> np.ndarray:
        """Unit quaternions x, y, z, w, (n, 4)."""
        return self._core.rotations

    @property
    def velocities(self) -> np.ndarray:
        """Of the centres [m/s], (n, 3)."""
        return self._core.velocities

    @property
    def spins(self) -> np.ndarray:
        """Angular velocities in the bodies' frames [rad/s], (n, 3)."""
        return self._core.spins

    @property
    def names(self) -> list:
        """Of the bodies, then of the walls."""
        return self._core.names

    @property
    def time(self) -> float:
        """[s]"""
        return self._core.time

    @property
    def h(self) -> float:
        """Length of a step [s]."""
        return self._core.h

    @property
    def problem(self) -> Problem:
        """The friction problem of the last step, a copy."""
        return Problem(self._core.problem())

    @property
    def impulses(self) -> np.ndarray:
        """Its solution r [N s], (n, 3)."""
        return self._core.impulses

    def set_force(self, name: str, force: Sequence[float]) -> None:
        """From now on this force [N], world frame, is on that body or driven wall."""
        self._core.set_force(name, force)
