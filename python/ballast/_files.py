"""What runs and comparisons leave in files, as arrays."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from typing import List

import numpy as np

from . import _ballast
from ._problem import Path, Problem


@dataclasses.dataclass(frozen=True)
class Captured:
    """A friction problem as a run met it (`ballast run --capture`); n contacts."""

    problem: Problem
    start: np.ndarray  #: the warm start, r of the step before [N s], (n, 3)
    solution: np.ndarray  #: the run's solver's answer at its tolerance [N s], (n, 3)
    gap: np.ndarray  #: [m], (n); negative: overlap
    frame: np.ndarray  #: normal, two tangents, in the world, (n, 3, 3)
    position: np.ndarray  #: of the contact in the world [m], (n, 3)
    key: np.ndarray  #: names the features that touch; constant while they do, (n)
    bodies: np.ndarray  #: numbers of the two bodies in the scene, walls included, (n, 2)
    h: float  #: length of the step [s]
    g: float  #: gravity [m/s^2]
    step: int  #: number of the step in the run, counted from 1
    time: float  #: end of the step [s]
    phase: str  #: of the driven wall: none, jammed, active, passive
    wall_x: float  #: place [m], velocity [m/s] and load [N] of the driven wall
    wall_v: float
    load: float
    velocity_scale: float  #: g h, by which errors are quoted [m/s]

    @classmethod
    def read(cls, file: Path) -> "Captured":
        parts = _ballast.captured(os.fspath(file))
        for name in ("start", "solution", "position"):
            parts[name] = parts[name].reshape(-1, 3)
        parts["frame"] = parts["frame"].reshape(-1, 3, 3)
        parts["bodies"] = np.column_stack([parts.pop("id_a"), parts.pop("id_b")])
        return cls(problem=Problem(parts.pop("problem")), **parts)


class Record:
    """The record of a finished run: its folder, or record.h5. record["steps/wall_x"] and
    record["poses/position"] are arrays; docs/manual/records.md has every name with its shape. Each
    is read when it is asked for."""

    def __init__(self, run: Path):
        path = pathlib.Path(run)
        self.file = str(path / "record.h5" if path.is_dir() else path)
        self.bodies: List[str] = _ballast.texts(self.file, "/bodies/name")

    def __getitem__(self, name: str) -> np.ndarray:
        return _ballast.dataset(self.file, "/" + name.lstrip("/"))

    @property
    def steps(self) -> dict:
        """Every column of the steps: pandas.DataFrame(record.steps) is a table."""
        return {name: self["steps/" + name] for name in _ballast.step_columns()}


def rows(folder: Path) -> List[dict]:
    """The rows of a comparison, one dict for each solve, with its history:
    pandas.DataFrame(ballast.rows("results/compare")) is a table. What is not known is None."""
    files = sorted((pathlib.Path(folder) / "rows").glob("*.json"))
    if not files:
        raise _ballast.Error("%s: no folder of a comparison: it has no rows" % os.fspath(folder))
    found = []
    for file in files:
        try:
            found.append(json.loads(file.read_text()))
        except ValueError:
            raise _ballast.Error("%s: is no row of a comparison" % file) from None
    return found
