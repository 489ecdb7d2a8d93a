"""Where the time of a transfer went: alone, sharing, contention, hidden interference.

Definition. A transfer alone on its route would run at its solo rate b, the least clean bandwidth
B of its links. While its rate is r < b for d microseconds, it loses d (1 - r / b) of them. On the
bottleneck link, r = B g h / k: k flows share it (sharing), hidden interferers leave the factor h
(hidden), and carrier-sense contention the rest g of the link's factor (contention). The loss
is divided among the three in proportion to ln k, -ln g and -ln h: the only division in which the
order of the causes does not matter and halving the rate twice by one cause weighs twice. At zero
rate, the cause whose factor is zero takes the whole loss. Under a model that decides the rates of
whole routes, r need not be an equal share of the bottleneck: what k and h leave unexplained counts
as contention, the hops of one transfer that contend with each other among it.

Whole microseconds: the time alone is size / b rounded up as the engine rounds; the rest is divided
among the causes in proportion to their losses by largest remainder, ties in the order sharing,
contention, hidden. What no recorded cause explains, less than a microsecond of rounding, counts as
time alone; in a coarse trace all of it is ``unattributed_loss``.
"""

import math
from collections.abc import Sequence
from enum import StrEnum
from typing import Final

from ncsim_core.trace.run_trace import RateStep, RunTrace, RunTransfer
from ncsim_core.units import service_time_us


class Part(StrEnum):
    """What a stretch of a run's time was spent on."""

    INJECTION_WAIT = "injection_wait"
    """Before the DAG entered."""
    COMPUTE = "compute"
    """A task ran."""
    QUEUE_WAIT = "queue_wait"
    """A task was ready, its node busy."""
    LATENCY = "latency"
    """A transfer had been created, its bytes not yet begun."""
    TRANSFER_ALONE = "transfer_alone"
    """What a transfer takes with its route to itself."""
    SHARING_LOSS = "sharing_loss"
    """Lost to other transfers on the bottleneck link."""
    CONTENTION_LOSS = "contention_loss"
    """Lost to links that the bottleneck senses and shares the channel with."""
    HIDDEN_LOSS = "hidden_loss"
    """Lost to hidden interferers of the bottleneck."""
    UNATTRIBUTED_LOSS = "unattributed_loss"
    """Lost to one of the three before, which a coarse trace does not tell."""


LOSSES: Final = (Part.SHARING_LOSS, Part.CONTENTION_LOSS, Part.HIDDEN_LOSS)


def service_parts_us(transfer: RunTransfer, run: RunTrace) -> dict[Part, int]:
    """Return what a transfer's time of byte service was spent on; the parts sum to it.

    Args:
        transfer: One that has ended.
        run: Its run.
    """
    took_us = (transfer.ended_us or 0) - (transfer.started_us or 0)
    alone_us = min(took_us, service_time_us(transfer.size_MB, run.solo_MBps(transfer)))
    lost_us = took_us - alone_us
    if not run.has_rates:
        return {Part.TRANSFER_ALONE: alone_us, Part.UNATTRIBUTED_LOSS: lost_us}
    losses = _losses_us(transfer, run)
    if not any(losses):
        return {Part.TRANSFER_ALONE: took_us}
    divided = dict(zip(LOSSES, divide(lost_us, losses), strict=True))
    return {Part.TRANSFER_ALONE: alone_us} | divided


def _losses_us(transfer: RunTransfer, run: RunTrace) -> list[float]:
    """Return the time lost to sharing, contention and hidden interference, unrounded."""
    totals = [0.0, 0.0, 0.0]
    solo_MBps = run.solo_MBps(transfer)
    for step, end_us in run.rate_spans(transfer):
        lost_us = max(0.0, (end_us - step.at_us) * (1 - step.rate_MBps / solo_MBps))
        for index, weight in enumerate(_weights(step, run)):
            totals[index] += lost_us * weight
    return totals


def _weights(step: RateStep, run: RunTrace) -> tuple[float, float, float]:
    """Return the shares of sharing, contention and hidden interference in a loss; sum 1 or 0."""
    clean_MBps = run.links[step.bottleneck].bandwidth_MBps
    if step.rate_MBps <= 0:
        return (0.0, 0.0, 1.0) if step.hidden_factor <= 0 else (0.0, 1.0, 0.0)
    sharing = math.log(max(1, step.flows))
    hidden = -math.log(min(1.0, step.hidden_factor)) if step.hidden_factor > 0 else 0.0
    contention = max(0.0, math.log(clean_MBps) - math.log(step.rate_MBps) - sharing - hidden)
    total = sharing + contention + hidden
    return (sharing / total, contention / total, hidden / total) if total > 0 else (0.0, 0.0, 0.0)


def divide(total: int, weights: Sequence[float]) -> list[int]:
    """Return whole shares of ``total`` in proportion to ``weights``, by largest remainder.

    Ties go to the first.

    Args:
        total: To be divided, 0 or more.
        weights: 0 or more, not all 0.

    >>> divide(10, [1.0, 1.0, 1.0])
    [4, 3, 3]
    """
    whole = math.fsum(weights)
    exact = [total * (weight / whole) for weight in weights]
    shares = [min(total, math.floor(each)) for each in exact]
    by_remainder = sorted(range(len(shares)), key=lambda i: shares[i] - exact[i])
    for index in by_remainder[: total - sum(shares)]:
        shares[index] += 1
    return shares
