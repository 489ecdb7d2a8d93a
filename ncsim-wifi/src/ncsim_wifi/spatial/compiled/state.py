"""What a step of the iteration starts from and leaves, and what happens within it."""

from typing import NamedTuple

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray, IntArray
from ncsim_wifi.spatial.attempts import Exchange
from ncsim_wifi.spatial.compiled.tables import Records, layout

LINK_STATE = layout(f8="attempts loss answered packets", by_stage="stages")
"""a_l, share in the attempts of its station; share of lost frames; part of its RTS that are
answered; packets per time; q_l(k), share of attempts in each stage."""

STATION_STATE = layout(f8="activity silenced blocked silent_us", by_stage="stages")
"""alpha, part of the time in which it has a frame; how often it is silenced by CTS of hidden
receivers; B, how often by summed power; b_u; q_u(k)."""


class State(NamedTuple):
    """The state of a ``FixedPoint``, written in place.

    Args:
        links: Records ``LINK_STATE``.
        stations: Records ``STATION_STATE``.
        clear: C of the occupancy.
        deviation_us: dev[u, w].
        eager: How much more often than on average the interferer of each relation attempts
            while the sender is in a stage.
        given: P(b | a) of each relation with a chain, shape (relations, 7, 7).
        known: How many of these are known: none or all.
    """

    links: Records
    stations: Records
    clear: FloatArray
    deviation_us: FloatArray
    eager: FloatArray
    given: FloatArray
    known: IntArray


class Traffic(NamedTuple):
    """What stations do in one step; see ``losses.Traffic``."""

    on: FloatArray
    same_slot: FloatArray
    tau: FloatArray
    rate_per_us: FloatArray
    cycle_us: FloatArray
    times: Exchange
    sending: FloatArray


@inlined
def station_means(links: Records, state: State, values: FloatArray) -> FloatArray:
    """Return for each station the mean over its links, shape (stations, columns)."""
    columns = values.shape[1]
    means = np.zeros((len(state.stations), columns))
    for link in range(len(links)):
        u, share = links[link].station, state.links[link].attempts
        for column in range(columns):
            means[u, column] += share * values[link, column]
    return means
