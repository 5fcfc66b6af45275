# The compiled part of the package, as type checkers see it.
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]

smallest_tolerance: float

class Pairs:
    @property
    def dimension(self) -> int: ...
    def evaluate(self, charges: Any) -> tuple[Array, Array]: ...
    def choice(self) -> dict[str, Any]: ...

def plan(kernel: str, sources: Any, targets: Any, tolerance: float, method: str, threads: int, core_radius: float,
         potential: bool, memory_limit: int, most_seconds: float) -> Pairs: ...
