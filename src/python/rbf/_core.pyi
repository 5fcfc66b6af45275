# The compiled part of the package, as type checkers see it.
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]

smallest_tolerance: float

class Sums:
    @property
    def dimension(self) -> int: ...
    def set_weights(self, weights: Any) -> None: ...
    def choice(self) -> dict[str, Any]: ...

def plan(kernel: str, shape: float, centres: Any, weights: Any, tolerance: float, derivatives: int, method: str,
         threads: int, memory_limit: int, most_seconds: float, range: float, expected_targets: int,
         expected_grid: list[list[float]]) -> Sums: ...
def fit(kernel: str, shape: float, points: Any, values: Any, accuracy: float, regularisation: float, solver: str,
        threads: int, memory_limit: int) -> tuple[Sums, Array, Array]: ...
def range_of(centres: Any, targets: Any) -> float: ...
