"""Friction problems and their parts."""

from __future__ import annotations

import os
from typing import Any, Optional, Union

import numpy as np
import scipy.sparse as sparse

from . import _ballast

Path = Union[str, "os.PathLike[str]"]


def _require_shape(matrix: Any, rows: int, columns: int, name: str) -> None:
    if matrix.shape != (rows, columns):
        raise ValueError(f"{name}: is {matrix.shape[0]} x {matrix.shape[1]}, "
                         f"must be {rows} x {columns}")


def _compressed(form: type, matrix: Any, name: str) -> Any:
    """A copy in that form, each entry once. SciPy believes indices: they are checked before."""
    try:
        if hasattr(matrix, "check_format"):
            matrix = matrix.copy()
            matrix.check_format(full_check=True)
        elif sparse.issparse(matrix):
            matrix = sparse.coo_matrix(matrix)  # which checks the indices
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None
    matrix = form(matrix)
    matrix.sum_duplicates()
    return matrix


def _frictions(mu: Any) -> np.ndarray:
    mu = np.asarray(mu, dtype=float)
    if mu.shape not in ((mu.size,), (mu.size, 1)):
        raise ValueError(f"mu: has the shape {mu.shape}, must have (n,), one for each contact")
    return mu.ravel()


def _require_real(*arrays: Any) -> None:
    if any(np.iscomplexobj(array) for array in arrays):
        raise ValueError("expected real numbers, got complex ones")


class Problem:
    """A friction problem. Made by from_delassus, from_bodies or read; it does not change."""

    def __init__(self, core: _ballast.Problem):
        self._core = core

    @classmethod
    def from_delassus(cls, W: Any, q: np.ndarray, mu: np.ndarray) -> "Problem":
        """From W [1/kg], dense or sparse, (3n, 3n), positive semidefinite; q [m/s], (3n) or (n, 3);
        mu, (n). Raises ValueError and InvalidProblem, which names the entry."""
        _require_real(W, q, mu)
        W, mu = _compressed(sparse.csr_matrix, W, "W"), _frictions(mu)
        _require_shape(W, 3 * len(mu), 3 * len(mu), "W")
        return cls(_ballast.Problem.from_delassus(W, q, mu))

    @classmethod
    def from_bodies(cls, M: Any, H: Any, mu: np.ndarray, v_free: Optional[np.ndarray] = None,
                    f: Optional[np.ndarray] = None, w: Optional[np.ndarray] = None) -> "Problem":
        """From M [kg, kg m^2], (d, d), symmetric positive definite; H, (3n, d), with u = H v + w;
        mu, (n); v_free [m/s, rad/s], (d), or f = M v_free; w [m/s], (3n), zero if left out."""
        _require_real(M, H, mu, v_free, f, w)
        M, mu = _compressed(sparse.csc_matrix, M, "M"), _frictions(mu)
        transposed = _compressed(sparse.csr_matrix, H, "H").T
        if (v_free is None) == (f is None):
            raise ValueError("expected one of v_free and f")
        if v_free is not None:
            v = np.asarray(v_free, dtype=float).ravel()
            _require_shape(M, len(v), len(v), "M")
            f = M @ v
        f = np.asarray(f, dtype=float).ravel()
        if w is None:
            w = np.zeros(3 * len(mu))
        _require_shape(M, len(f), len(f), "M")
        _require_shape(transposed.T, 3 * len(mu), len(f), "H")
        return cls(_ballast.Problem.from_bodies(M, transposed, f, w, mu))

    @classmethod
    def read(cls, file: Path) -> "Problem":
        """A stored problem: FCLIB .hdf5, Siconos .dat, captured by a run."""
        return cls(_ballast.Problem.read(os.fspath(file)))

    def write(self, file: Path) -> None:
        """As FCLIB's HDF5: by its bodies where these are known, else W and q."""
        if os.path.splitext(os.fspath(file))[1] not in (".hdf5", ".h5"):
            raise ValueError(f"{file}: only .hdf5 and .h5 are written")
        self._core.write(os.fspath(file))

    @property
    def W(self) -> sparse.csr_matrix:
        """The Delassus matrix [1/kg], (3n, 3n): the problem's own memory, which cannot be written;
        built where only bodies are known."""
        return self._core.delassus()

    @property
    def M(self) -> sparse.csc_matrix:
        """Masses [kg, kg m^2], (d, d). Raises ValueError where only W is known; so do H and f."""
        return self._core.bodies()[0]

    @property
    def H(self) -> sparse.csr_matrix:
        """u = H v + w, (3n, d)."""
        return self._core.bodies()[1].T

    @property
    def f(self) -> np.ndarray:
        """M v_free [N s, N m s], (d)."""
        return self._core.bodies()[2]

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
