"""Binary exponential back-off: windows, attempt probability, how often each stage is visited."""

import numpy as np

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.sums import row_sums

STAGES = 7  # attempts 0..6; after seven failures the window starts anew (MODEL 1)
WINDOWS = np.minimum(16.0 * 2.0 ** np.arange(STAGES), 1024.0)
LONGEST_COUNTS = WINDOWS - 1.0
MEAN_COUNTS = LONGEST_COUNTS / 2.0
FIRST_MEAN_COUNT = 7.5


def mean_count(stage_visits: FloatArray) -> FloatArray:
    """Return beta, the mean number of slots counted before an attempt.

    Source: MODEL 3.1.

    Args:
        stage_visits: Share of attempts made in each stage, shape (..., 7).

    >>> float(mean_count(np.eye(7)[0]))
    7.5
    """
    return row_sums(stage_visits * MEAN_COUNTS)


def attempt_probability(count: FloatArray) -> FloatArray:
    """Return tau, the probability of an attempt per decision, after a mean number of slots.

    Source: MODEL 3.1; Bianchi (2000), Eq. 7, for a fixed mean.
    """
    return 1.0 / (1.0 + count)


def visits_per_packet(success: FloatArray) -> FloatArray:
    """Return v, the expected number of attempts in each stage per round of the window.

    Source: MODEL 3.11.

    Args:
        success: Probability that an attempt succeeds, by stage, shape (..., 7).
    """
    visits = np.ones_like(success)
    np.multiply.accumulate(1.0 - success[..., :-1], axis=-1, out=visits[..., 1:])
    return visits
