"""A second solver of Bianchi's equations: 60 decimal digits, another form, another unknown."""

from decimal import Decimal, localcontext

DIGITS = 60
STEPS = 220


def decimal_tau(stations: int, window: int = 16, max_stage: int = 6) -> Decimal:
    """Return tau of ``stations``, halving an interval of tau instead of p.

    Uses the closed form with (1 - 2p), not the finite sum.

    Source: Eqs. 6 and 7 (``eq:tau``, ``eq:p``); Appendix A (``app:timing``).
    """
    with localcontext() as context:
        context.prec = DIGITS
        low, high = Decimal(0), Decimal(2) / Decimal(window + 1)
        for _ in range(STEPS):
            tau = (low + high) / 2
            if tau < _tau_of(1 - (1 - tau) ** (stations - 1), window, max_stage):
                low = tau
            else:
                high = tau
        return (low + high) / 2


def _tau_of(p: Decimal, window: int, max_stage: int) -> Decimal:
    free = 1 - 2 * p
    if free == 0:
        return Decimal(2) / (window + 1 + window * p * max_stage)
    return 2 * free / (free * (window + 1) + p * window * (1 - (2 * p) ** max_stage))
