"""What should come out, worked out without the engine and without the model's code.

A scene's transfers are fluids: between two starts or ends all rates are constant. Each rate is
taken from the paper's formulas literally, in decibels and floating point, from the positions.
Only the files with the rate tables are shared with the code that is validated.
"""

import math
from collections.abc import Callable, Sequence

from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.validation.literal_mac import airtime_fraction, goodput_Mbps
from ncsim_wifi.validation.scenes import Scene

Factor = Callable[[int, frozenset[int], Scene], float]


def power_dBm(a: tuple[float, float], b: tuple[float, float], scene: Scene) -> float:
    """Return what ``b`` receives of ``a``: Eqs. 2 and 3."""
    radio = scene.radio
    loss_at_1m_dB = 20.0 * math.log10(4.0 * math.pi * radio.freq_ghz * 1e9 / 3e8)
    loss_dB = 10.0 * radio.path_loss_exponent * math.log10(max(1.0, math.dist(a, b)))
    return radio.tx_power_dBm - loss_at_1m_dB - loss_dB


def clean_rate_Mbps(link: int, scene: Scene) -> float:
    """Return the rate of a link that is alone: Eq. 4."""
    signal_dBm = power_dBm(scene.senders_m[link], scene.receivers_m[link], scene)
    return _rate_for(signal_dBm - scene.radio.noise_floor_dBm, 0.0, scene)


def _rate_for(ratio_dB: float, margin_dB: float, scene: Scene) -> float:
    table = read_table(scene.radio.wifi_standard)
    scale = scene.radio.channel_width_mhz / 20.0
    met = [
        rate_Mbps * scale
        for threshold_dB, rate_Mbps in zip(table.snr_min_dB, table.rate_Mbps, strict=True)
        if ratio_dB >= threshold_dB - margin_dB
    ]
    return max(met, default=0.0)


def conflict(one: int, other: int, scene: Scene) -> bool:
    """Return whether two links may not send together (Section IV-F)."""
    a, b = scene.senders_m[one], scene.receivers_m[one]
    c, d = scene.senders_m[other], scene.receivers_m[other]
    if {a, b} & {c, d}:
        return True
    pairs = [(a, c), (a, d), (b, c)] + ([(b, d)] if scene.radio.rts_cts else [])
    return any(power_dBm(x, y, scene) >= scene.radio.cca_threshold_dBm for x, y in pairs)


def hidden_powers_dBm(link: int, active: frozenset[int], scene: Scene) -> dict[int, float]:
    """Return the active hidden interferers of a link, and their power at its receiver."""
    powers = {
        other: power_dBm(scene.senders_m[other], scene.receivers_m[link], scene)
        for other in sorted(active - {link})
        if not conflict(link, other, scene)
    }
    cutoff_dBm = scene.radio.interference_cutoff_dBm
    return {other: power for other, power in powers.items() if power >= cutoff_dBm}


def sinr_dB(link: int, interferers_dBm: Sequence[float], scene: Scene) -> float:
    """Return the ratio of signal to noise and interference: Eq. 9."""
    signal_dBm = power_dBm(scene.senders_m[link], scene.receivers_m[link], scene)
    noise_mW = 10.0 ** (scene.radio.noise_floor_dBm / 10.0)
    unwanted_mW = noise_mW + sum(10.0 ** (each / 10.0) for each in interferers_dBm)
    return 10.0 * math.log10(10.0 ** (signal_dBm / 10.0) / unwanted_mW)


def stations(link: int, active: frozenset[int], scene: Scene) -> int:
    """Return n, a link and its active contenders."""
    return 1 + sum(conflict(link, other, scene) for other in active - {link})


def effective_rate_factor(link: int, active: frozenset[int], scene: Scene) -> float:
    """Return the factor of the default model: Eqs. 10 to 12."""
    clean_Mbps = clean_rate_Mbps(link, scene)
    effective_Mbps = clean_Mbps
    hidden = hidden_powers_dBm(link, active, scene)
    if hidden:
        ratio_dB = sinr_dB(link, list(hidden.values()), scene)
        effective_Mbps = min(clean_Mbps, _rate_for(ratio_dB, scene.radio.capture_margin_dB, scene))
    if effective_Mbps == 0.0:
        return 0.0
    n, rts_cts = stations(link, active, scene), scene.radio.rts_cts
    served_Mbps = goodput_Mbps(n, effective_Mbps, rts_cts=rts_cts) / n
    return served_Mbps / goodput_Mbps(1, clean_Mbps, rts_cts=rts_cts)


def fixed_capture_factor(link: int, active: frozenset[int], scene: Scene) -> float:
    """Return the factor of the optional fixed-capture mode for at most one interferer."""
    clean_Mbps = clean_rate_Mbps(link, scene)
    n = stations(link, active, scene)
    factor = goodput_Mbps(n, clean_Mbps) / (n * goodput_Mbps(1, clean_Mbps))
    for other, interferer_dBm in hidden_powers_dBm(link, active, scene).items():
        ratio_dB = sinr_dB(link, [interferer_dBm], scene)
        if _rate_for(ratio_dB, scene.radio.capture_margin_dB, scene) < clean_Mbps:
            factor *= 1.0 - airtime_fraction(clean_rate_Mbps(other, scene))
    return factor


def clean_goodput_MBps(link: int, scene: Scene) -> float:
    """Return B, what a link offers alone."""
    rate_Mbps = clean_rate_Mbps(link, scene)
    if rate_Mbps == 0.0:
        return 0.0
    return goodput_Mbps(1, rate_Mbps, rts_cts=scene.radio.rts_cts) / 8.0


def rates_MBps(
    flowing: Sequence[int], scene: Scene, factor: Factor = effective_rate_factor
) -> dict[int, float]:
    """Return the rate of each flow while just these flow: Eq. 1."""
    by_link: dict[int, list[int]] = {}
    for flow in flowing:
        by_link.setdefault(scene.flows[flow].link, []).append(flow)
    active = frozenset(by_link)
    return {
        flow: clean_goodput_MBps(link, scene) * factor(link, active, scene) / len(flows)
        for link, flows in by_link.items()
        for flow in flows
    }


def ends_s(scene: Scene, factor: Factor = effective_rate_factor) -> list[float]:
    """Return when each flow ends, phase by phase; infinite if it never does."""
    left_MB = {number: flow.size_MB for number, flow in enumerate(scene.flows)}
    ends = [math.inf] * len(scene.flows)
    now_s = 0.0
    while left_MB:
        flowing = [flow for flow in left_MB if scene.flows[flow].start_s <= now_s]
        rates = rates_MBps(flowing, scene, factor)
        end_s = {f: now_s + left_MB[f] / rate for f, rate in rates.items() if rate > 0.0}
        starts_s = [scene.flows[f].start_s for f in left_MB if scene.flows[f].start_s > now_s]
        next_s = min([*end_s.values(), *starts_s], default=math.inf)
        if next_s == math.inf:
            break
        for flow, rate in rates.items():
            left_MB[flow] -= rate * (next_s - now_s)
            if end_s.get(flow) == next_s:
                ends[flow] = next_s
                del left_MB[flow]
        now_s = next_s
    return ends
