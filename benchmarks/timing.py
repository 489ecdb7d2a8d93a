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


def fixed_work() -> int:
    """Do plain Python work that never changes, to see how fast this machine is just now."""
    total = 0
    for number in range(2_000_000):
        total += number & 7
    return total


if __name__ == "__main__":
    print(f"fixed work {cpu_median_s(fixed_work):.4f} s")
