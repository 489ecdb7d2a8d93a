"""What all benchmarks measure with: CPU time, medians, garbage collected before."""

import gc
import statistics
import time
from collections.abc import Callable


def cpu_median_s(work: Callable[[], object], repeats: int = 5) -> float:
    """Return the median CPU time (s) of some work in this process."""
    spent = []
    for _ in range(repeats):
        gc.collect()
        started_s = time.process_time()
        work()
        spent.append(time.process_time() - started_s)
    return statistics.median(spent)
