"""The simulator: a density that moves with a flow, carried by particles.

>>> import gaussdrift
>>> cone = {"gaussdrift": 1,
...         "domain": {"min": [-1, -1], "max": [1, 1]},
...         "velocity": {"u": ["-y", "x"]},
...         "density": {"shape": "wendland", "center": [0.5, 0], "radius": 0.25},
...         "particles": {"per_axis": 60},
...         "time": {"end": "pi", "step": 0.1},
...         "evaluate": {"per_axis": 40},
...         "output": {"times": [0, "pi"]},
...         "reference": {"kind": "characteristics"}}
>>> result = gaussdrift.run(cone)
>>> result.frames[-1].density.shape
(40, 40)
>>> bool(abs(result.series["mass"][1] - result.series["mass"][0]) < 1e-12)
True

A case is the path of a case file, its text, or a dictionary with the same tables (docs/cases.md). Nothing is printed and no
file is written. Other threads run during a run, and Ctrl-C ends it.
"""
from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable, Mapping, Optional, Union

import numpy as np

from . import _core
from ._toml import literal, text_of

__all__ = ["Case", "CaseError", "Error", "FileError", "Frame", "InputError", "NumericalError", "Result", "check", "run"]

Array = np.ndarray[Any, np.dtype[np.float64]]
Given = Union[str, "os.PathLike[str]", Mapping[str, Any], "Case"]


class Error(Exception):
    """Base of the errors of this package. The texts are those of the program.

    >>> import gaussdrift
    >>> issubclass(gaussdrift.InputError, ValueError) and issubclass(gaussdrift.InputError, gaussdrift.Error)
    True
    """


class InputError(Error, ValueError):
    """A case or its data cannot be run: a step is not stable, the memory does not suffice.

    >>> import gaussdrift
    >>> issubclass(gaussdrift.CaseError, gaussdrift.InputError)
    True
    """


class CaseError(InputError):
    """A case is wrong. The text has all complaints with line and column; `count` is their number.

    >>> import gaussdrift
    >>> try:
    ...     gaussdrift.Case({"gaussdrift": 1, "domian": {"min": [0, 0], "max": [1, 1]}})
    ... except ValueError as error:
    ...     print("domian" in str(error) and "domain" in str(error))
    True
    """

    count: int


class NumericalError(Error, ArithmeticError):
    """A value is not finite, or an error bound cannot be kept. The text names step, time, particle and place.

    >>> import gaussdrift
    >>> issubclass(gaussdrift.NumericalError, ArithmeticError)
    True
    """


class FileError(Error, OSError):
    """A file cannot be read.

    >>> import gaussdrift
    >>> try:
    ...     gaussdrift.Case("absent.toml")
    ... except OSError as error:
    ...     print("absent.toml" in str(error))
    True
    """


class Case:
    """A case that has been read and is valid.

    case: the path of a case file; its text, if it has a line break; or a dictionary with the same tables.
    overrides: keys of the case with other values. Two low lines stand for the dot: evaluate__per_axis=100.
    threads: for fields that are fitted to samples; 0 for all.

    Raises CaseError (a ValueError) with all complaints, and FileError (an OSError).

    >>> import gaussdrift
    >>> case = gaussdrift.Case('''gaussdrift = 1
    ... domain = {min = [0, 0], max = [1, 1]}
    ... velocity = {u = [1, 0]}
    ... density = {shape = "gaussian", center = [0.3, 0.5], radius = 0.1}
    ... particles = {per_axis = 20}
    ... time = {end = 1, step = 0.1}
    ... ''', particles__per_axis=30)
    >>> "per_axis = 30" in case.text
    True
    """

    def __init__(self, case: Given, *, threads: int = 0, **overrides: Any) -> None:
        file = Path.cwd() / "case.toml"  # what messages call it; data files are looked for beside it
        if isinstance(case, Case):
            text, file = case.text, case._file
        elif isinstance(case, Mapping):
            text = text_of(case)
        elif isinstance(case, str) and "\n" in case:
            text = case
        else:
            file = Path(case)
            try:
                text = file.read_text(encoding="utf-8")
            except OSError as error:
                raise FileError(f"{file} cannot be read: {error.strerror}") from None
        self._file: Path = file
        settings = [f"{key.replace('__', '.')}={literal(value)}" for key, value in overrides.items()]
        #: The case itself, and what is odd about it.
        self._case, self.warnings = _core.parse(text, str(file), settings, threads)

    @property
    def text(self) -> str:
        """The text of a case file, defaults and overrides spelt out."""
        return self._case.text()

    @property
    def title(self) -> str:
        """One line for people."""
        return self._case.title

    def __repr__(self) -> str:
        return f"<gaussdrift.Case: {self.title or self._case.name}>"


@dataclass(frozen=True)
class Frame:
    """One output of a run. It owns its arrays.

    >>> import gaussdrift
    >>> gaussdrift.Frame.__dataclass_fields__["density"].type
    'Array'
    """

    index: int  #: 0 for the first output
    time: float  #: of the scene
    axes: list[Array]  #: coordinates of the grid, an array an axis
    density: Array  #: on the grid: density[i, k] is at (axes[0][i], axes[1][k]); mass / length^d
    exact: Optional[Array]  #: the exact density there, NaN where it is not known; None without a reference
    fields: dict[str, Array]  #: what output.fields names, on the grid; components of vectors along the last axis
    positions: Array  #: of the particles, N x d
    weights: Array  #: their masses
    ids: Any  #: their numbers


@dataclass(frozen=True)
class Result:
    """What a run has done.

    >>> import gaussdrift
    >>> sorted(gaussdrift.Result.__dataclass_fields__)
    ['case', 'checks', 'frames', 'series', 'summary', 'warnings']
    """

    case: Case  #: that was run
    frames: list[Frame]  #: the outputs
    #: A number for each output: time, mass, minimum, maximum, L1, L2, Linf (NaN without a reference), transform_error, seconds
    series: dict[str, Array]
    summary: dict[str, Any]  #: particles, grid_points, steps, spacing, core_radius, seconds, complete, ...
    checks: list[dict[str, Any]]  #: of the case: text, value, passed
    warnings: list[str] = field(default_factory=list)  #: about the case and the run


def run(case: Given, observer: Optional[Callable[[Frame], Any]] = None, *, keep: bool = True, threads: int = 0,
        **overrides: Any) -> Result:
    """Runs a case.

    case, overrides: as of Case.
    observer: called with each Frame. Where it returns False the run stops, and the summary says complete = False. What it
        raises ends the run.
    keep: whether the result has the frames. Without them a run needs memory for one.
    threads: 0 for all. Results do not depend on it.

    The settings that accuracy.target asks for are chosen first, where the case has one.
    Raises CaseError, InputError (ValueErrors), NumericalError (an ArithmeticError), FileError (an OSError), MemoryError.

    >>> import gaussdrift
    >>> times = []
    >>> result = gaussdrift.run({"gaussdrift": 1, "domain": {"min": [0, 0], "max": [1, 1]}, "velocity": {"u": [0.1, 0]},
    ...                          "density": {"shape": "gaussian", "center": [0.3, 0.5], "radius": 0.1},
    ...                          "particles": {"per_axis": 30}, "time": {"end": 1, "step": 0.1},
    ...                          "output": {"times": [0, 0.5, 1]}},
    ...                         observer=lambda frame: times.append(frame.time), keep=False, evaluate__per_axis=20)
    >>> times, result.frames
    ([0.0, 0.5, 1.0], [])
    """
    read = Case(case, threads=threads, **overrides)
    settled = _core.settled(read._case, threads) if read._case.has_target() else read._case
    frames: list[Frame] = []

    def see(told: dict[str, Any]) -> Any:
        frame = Frame(**told)
        if keep:
            frames.append(frame)
        return observer(frame) if observer else None

    summary = _core.run(settled, threads, see)
    return Result(read, frames, summary.pop("series"), summary, summary.pop("checks"),
                  [*read.warnings, *summary.pop("warnings")])


def check(case: Given, *, threads: int = 0, **overrides: Any) -> dict[str, Any]:
    """What a run of the case would do and cost, without running it: what `gaussdrift check --json` prints.

    case, overrides: as of Case. The settings are taken as they are. Raises what run() raises before its first step.

    >>> import gaussdrift
    >>> told = gaussdrift.check({"gaussdrift": 1, "domain": {"min": [0, 0], "max": [1, 1]}, "velocity": {"u": [0.1, 0]},
    ...                          "density": {"shape": "gaussian", "center": [0.3, 0.5], "radius": 0.1},
    ...                          "particles": {"per_axis": 30}, "time": {"end": 1, "step": 0.1}})
    >>> isinstance(told, dict) and len(told) > 5
    True
    """
    told: dict[str, Any] = json.loads(_core.check(Case(case, threads=threads, **overrides)._case, threads)[1])
    return told
