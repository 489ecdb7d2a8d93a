"""What frames survive interferers that exclude each other, relation by relation.

Source: MODEL 3.8; see ``ncsim_wifi.spatial.groups``.
"""

import numpy as np
from ncsim_core.compiling import inlined

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.compiled.elementary import exp, log
from ncsim_wifi.spatial.compiled.state import Traffic
from ncsim_wifi.spatial.compiled.tables import Hidden
from ncsim_wifi.spatial.gaps import Interferers
from ncsim_wifi.spatial.groups import LEAST_HIT, LEAST_PART, Members


@inlined
def share_groups(
    hidden: Hidden, traffic: Traffic, met: Interferers, members: Members, missed: FloatArray
) -> None:
    """Make what survives members of groups what survives their groups."""
    relations, phi, survives = hidden.relations, members.phi, members.survives
    root = _roots(hidden, traffic, met, members, missed)
    mean, in_group = np.zeros(len(phi)), np.zeros(len(hidden.link_of_group))
    for at in range(len(phi)):
        group = relations[at].group
        if not relations[at].has_company:
            continue
        for k in range(STAGES):
            survives[at, k] = exp(root[group] * log(max(survives[at, k], LEAST_PART)))
            mean[at] = mean[at] + members.alone[at, k] * survives[at, k]
        mean[at] = phi[at] * mean[at]
        in_group[group] += mean[at]
    for at in range(len(phi)):
        group = relations[at].group
        if not relations[at].has_company:
            continue
        rest = (in_group[group] - mean[at]) / max(1.0 - phi[at], LEAST_PART)
        for k in range(STAGES):
            share = members.share[at, k]
            mixed = share * survives[at, k] + (1.0 - share) * rest
            survives[at, k] = exp(log(mixed) / root[group])


@inlined
def _roots(
    hidden: Hidden, traffic: Traffic, met: Interferers, members: Members, missed: FloatArray
) -> FloatArray:
    """Return 1 / n of each group, how many of its frames overlap one that is overlapped."""
    relations = hidden.relations
    root = np.zeros(len(hidden.link_of_group))
    for at in range(len(relations)):
        no_hit = members.alone[at, 0] * missed[at, 0]
        for k in range(1, STAGES):
            no_hit = no_hit + members.alone[at, k] * missed[at, k]
        exposed_us = relations[at].window_us + traffic.times.on_air_us[relations[at].station]
        number = exposed_us / (met.busy_us[at] / met.sum_on[at]) / max(1.0 - no_hit, LEAST_HIT)
        root[relations[at].group] += members.phi[at] / max(1.0, number)
    return root


@inlined
def share_groups_by_cts(hidden: Hidden, members: Members) -> None:
    """Do the same under RTS/CTS: the mean, by how likely each is the one that overlaps."""
    relations, phi, survives = hidden.relations, members.phi, members.survives
    in_group = np.zeros(len(hidden.link_of_group))
    for at in range(len(phi)):
        mean = 0.0
        for k in range(STAGES):
            mean = mean + members.alone[at, k] * survives[at, k]
        in_group[relations[at].group] += phi[at] * mean
    for at in range(len(phi)):
        if relations[at].has_company:
            for k in range(STAGES):
                rest = (1.0 - members.share[at, k]) * in_group[relations[at].group]
                survives[at, k] = members.share[at, k] * survives[at, k] + rest
