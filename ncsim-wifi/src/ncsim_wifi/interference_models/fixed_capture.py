"""Hidden interference as destroyed frames at a fixed rate: isolated pairs of hidden links only."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from ncsim_core.contracts.interference_model import Competition, InterferenceModel
from ncsim_core.errors import ModelScopeError, some_of
from ncsim_core.network import Link, LinkIndex
from typing_extensions import override

from ncsim_wifi.conflict import Relations
from ncsim_wifi.mac.efficiency import data_airtime_fraction
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.phy.mcs import rate_table
from ncsim_wifi.phy.received_power import sinr_dB
from ncsim_wifi.propagation import Propagation
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.radio import Radio, REFERENCE_CHANNEL_WIDTH_mhz
from ncsim_wifi.shares import Shares

MAX_LINKS_NAMED = 10
REMEDY = "Use hidden_model: effective_rate"


def capture_success(airtime_fraction: float, sinr_dB: float, decode_threshold_dB: float) -> float:
    """Return the part of frames that survive one hidden interferer.

    Source: Section VI-C (``sec:ns3_validation``), (1 - a) + a 1{SINR >= theta_decode}.

    Args:
        airtime_fraction: Part of time a in which the interferer sends data frames.
        sinr_dB: Ratio at the receiver while it does.
        decode_threshold_dB: From which ratio a frame is decoded all the same.

    >>> capture_success(0.6, 20.0, 17.0), capture_success(0.6, 10.0, 17.0)
    (1.0, 0.4)
    """
    return 1.0 if sinr_dB >= decode_threshold_dB else 1.0 - airtime_fraction


def uncovered_parameters(radio: Radio) -> list[str]:
    """Return what keeps fixed capture from covering a radio, in words; nothing if it does.

    Source: SPEC 6: 802.11ax at 20 MHz without RTS/CTS.

    >>> uncovered_parameters(Radio(rts_cts=True))
    ['rf.rts_cts is on']
    """
    faults = []
    if radio.wifi_standard != "ax":
        faults.append(f"rf.wifi_standard is {radio.wifi_standard!r}")
    if radio.channel_width_mhz != REFERENCE_CHANNEL_WIDTH_mhz:
        faults.append(f"rf.channel_width_mhz is {radio.channel_width_mhz}")
    if radio.rts_cts:
        faults.append("rf.rts_cts is on")
    return faults


@dataclass(frozen=True)
class Rivals:
    """The active links that a link is up against."""

    contenders: list[LinkIndex]
    interferers: list[LinkIndex]


class FixedCaptureModel(InterferenceModel):
    """Keeps the clean rate and loses the frames that a hidden interferer overlaps.

    Covers 802.11ax at 20 MHz without RTS/CTS, with at most one hidden interferer per receiver
    and no sensed contender beside it; asked about anything else, it raises ``ModelScopeError``
    with the links in question. Pure contention follows the default rule.

    Source: Section VI-C (``sec:ns3_validation``); SPEC 6.

    Args:
        links: All links, for messages.
        related: Conflict graph and hidden interference.
        signals: Powers and clean rates.
        radio: Radio parameters.
        shares: Factors by rates and number of stations.
    """

    def __init__(
        self,
        links: Sequence[Link],
        related: Relations,
        signals: Propagation,
        radio: Radio,
        shares: Shares,
    ) -> None:
        self._names = [link.id for link in links]
        self._related = related
        self._signals = signals
        self._radio = radio
        self._shares = shares
        self._timing = AxTiming(radio.rts_cts)

    @override
    def factors(self, links: Sequence[LinkIndex], active: Collection[LinkIndex]) -> FloatArray:
        rivals = {link: self._rivals(link, active) for link in links}
        self._check_scope(rivals)
        return np.array([self._factor(link, rivals[link]) for link in links], dtype=np.float64)

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        return self._related.reach(changed)

    @override
    def competition(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> Sequence[Competition]:
        rivals = {link: self._rivals(link, active) for link in links}
        self._check_scope(rivals)
        return [
            Competition(
                len(rivals[link].contenders),
                len(rivals[link].interferers),
                self._success(link, rivals[link]),
            )
            for link in links
        ]

    def _rivals(self, link: LinkIndex, active: Collection[LinkIndex]) -> Rivals:
        neighbourhood = set(self._related.conflicts(link).tolist())
        affecting = sorted(set(self._related.affecting(link).tolist()).intersection(active))
        return Rivals(
            [other for other in affecting if other in neighbourhood],
            [other for other in affecting if other not in neighbourhood],
        )

    def _factor(self, link: LinkIndex, rivals: Rivals) -> float:
        clean_Mbps = float(self._signals.rate_Mbps[link])
        contention = self._shares.factor(clean_Mbps, clean_Mbps, len(rivals.contenders) + 1)
        return max(self._shares.floor, contention * self._success(link, rivals))

    def _success(self, link: LinkIndex, rivals: Rivals) -> float:
        if not rivals.interferers:
            return 1.0
        (interferer,) = rivals.interferers
        rate_Mbps = float(self._signals.rate_Mbps[interferer])
        if rate_Mbps <= 0.0:
            return 1.0
        victims, powers_mW = self._related.hidden(interferer)
        power_mW = float(powers_mW[np.searchsorted(victims, link)])
        ratio_dB = sinr_dB(float(self._signals.signal_dBm[link]), self._noise_dBm, power_mW)
        airtime = data_airtime_fraction(rate_Mbps, self._timing)
        return capture_success(airtime, ratio_dB, self._decode_threshold_dB(link))

    @property
    def _noise_dBm(self) -> float:
        return self._radio.noise_floor_dBm

    def _decode_threshold_dB(self, link: LinkIndex) -> float:
        """Return the selection threshold of the link's rate less the margin (SPEC 6)."""
        table = rate_table(self._radio)
        clean_Mbps = float(self._signals.rate_Mbps[link])
        for threshold_dB, rate_Mbps in zip(table.snr_min_dB, table.rate_Mbps, strict=True):
            if math.isclose(rate_Mbps, clean_Mbps, rel_tol=1e-9):
                return threshold_dB - self._radio.capture_margin_dB
        raise ModelScopeError(
            f"hidden_model fixed_capture: link {self._names[link]!r} has a hidden interferer, and "
            f"its bandwidth of {clean_Mbps:g} Mb/s is no rate of the table; no frame of it can be "
            "said to be decoded or not"
        )

    def _check_scope(self, rivals: dict[LinkIndex, Rivals]) -> None:
        if rivals and (faults := uncovered_parameters(self._radio)):
            raise ModelScopeError(
                "hidden_model fixed_capture covers 802.11ax at 20 MHz without RTS/CTS only "
                f"({', '.join(faults)}), so it cannot serve links {self._named(list(rivals))}. "
                + REMEDY
            )
        beyond = [
            f"{self._names[link]!r} (contenders: {self._named(rival.contenders)}; "
            f"hidden interferers: {self._named(rival.interferers)})"
            for link, rival in rivals.items()
            if len(rival.interferers) > 1 or (rival.interferers and rival.contenders)
        ]
        if beyond:
            raise ModelScopeError(
                "hidden_model fixed_capture covers one hidden interferer per receiver and no "
                f"contender beside it; beyond that are links {', '.join(beyond)}. " + REMEDY
            )

    def _named(self, links: Sequence[LinkIndex]) -> str:
        return some_of([repr(str(self._names[link])) for link in links], MAX_LINKS_NAMED) or "none"
