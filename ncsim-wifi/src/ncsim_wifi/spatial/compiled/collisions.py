"""Frames lost to noise and to stations that start in the same slot, link by link.

Source: MODEL 3.5 and 3.6; see ``ncsim_wifi.spatial.collisions``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.compiled.handshake import unaware_survival
from ncsim_wifi.spatial.compiled.near import far_noise_survival, others_survival
from ncsim_wifi.spatial.compiled.state import State, Traffic
from ncsim_wifi.spatial.compiled.tables import Air, Constants, Records
from ncsim_wifi.spatial.overlap import LARGEST_ON


@inlined
def base_success(constants: Constants, air: Air, state: State, traffic: Traffic) -> FloatArray:
    """Return what noise, same-slot collisions and stations beyond the nearest leave of frames."""
    sending = traffic.sending
    base = far_noise_survival(constants, air, sending)
    for link in range(len(base)):
        if not air.links[link].is_alive:
            base[link] = 0.0
        elif constants.same_slot_collisions:
            base[link] = base[link] * _survivors(air, traffic.same_slot, link)
    if len(air.others):
        multiply(base, others_survival(air, sending, traffic.times.on_air_us))
    if constants.rts_cts:
        multiply(base, unaware_survival(air, state, traffic))
    return base


@inlined
def multiply(values: FloatArray, factors: FloatArray) -> None:
    """Multiply numbers in place."""
    for at in range(len(values)):
        values[at] *= factors[at]


@inlined
def _survivors(air: Air, same_slot: FloatArray, link: int) -> float:
    """Return what same-slot collisions leave of the frames of one link."""
    product, u = 1.0, air.links[link].station
    for w in range(len(same_slot)):
        if air.by_power[u, w]:
            product = product * (1.0 - same_slot[u, w] * air.meetings[link, w].same_slot_loss)
    return product


@inlined
def partner_collisions(
    air: Air,
    relations: Records,
    state: State,
    traffic: Traffic,
    during: FloatArray,
    base: FloatArray,
) -> None:
    """Multiply by what same-slot collisions with partners by summed power leave."""
    product = np.ones(len(base))
    for at in range(len(during)):
        link, w = relations[at].link, relations[at].station
        meets = traffic.tau[w] * state.clear[relations[at].own, w]
        lost = meets * (1.0 - during[at]) * air.meetings[link, w].same_slot_loss
        product[link] *= 1.0 - min(lost, LARGEST_ON)
    multiply(base, product)
