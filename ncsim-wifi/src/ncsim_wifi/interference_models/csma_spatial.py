"""The interference model ``csma_spatial``: what packets get, for any set of active links."""

from collections.abc import Collection, Sequence
from functools import partial

import numpy as np
from ncsim_core.context import BuildContext, ModelCache
from ncsim_core.contracts.interference_model import Competition, InterferenceModel, RouteRates
from ncsim_core.network import LinkIndex, Route
from typing_extensions import override

from ncsim_wifi.phy.mcs import rate_table
from ncsim_wifi.propagation import is_on_air, propagation, require_positions
from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.radio import Radio
from ncsim_wifi.spatial.hazard import hazard_table
from ncsim_wifi.spatial.occupancy import connected_components
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.saturated import saturated_goodputs_MBps
from ncsim_wifi.spatial.settings import Settings, Terms
from ncsim_wifi.spatial.transfers import Paths

MAX_SOLVED_SETS = 4096
RATE_TOLERANCE = 1e-9


def csma_spatial(  # noqa: PLR0913 - one keyword per term that can be left out
    context: BuildContext,
    *,
    same_slot_collisions: bool = True,
    hidden_loss: bool = True,
    joint_interference: bool = True,
    joint_chains: bool = True,
    helpers_by_stage: bool = True,
    ack_loss: bool = True,
    silence: bool = True,
    energy_sensing: bool = True,
    far_noise: bool = True,
    simulator_artefacts: bool = False,
    relaying: bool = True,
) -> "CsmaSpatialModel":
    """Return the model; the runs of a process share one per network and options.

    Args:
        context: Network and config section ``rf``.
        same_slot_collisions: Stations that sense each other may start in the same slot.
        hidden_loss: Stations that do not sense each other destroy frames.
        joint_interference: Several weak interferers act together.
        joint_chains: Back-off stages of two stations that hurt each other are correlated.
        helpers_by_stage: So is how active those are that harm a third together.
        ack_loss: Acknowledgements of hidden links destroy frames.
        silence: Who does not understand a frame waits another time after it.
        energy_sensing: Stations too weak to be sensed alone are sensed together.
        far_noise: Interferers beyond the nearest raise the noise.
        simulator_artefacts: Links below the sensing threshold get nothing, and who loses a
            signalling field finds the channel idle, as in ns-3.
        relaying: Relays of a transfer forward only what they receive; otherwise every hop is
            saturated.

    Raises:
        ScenarioError: Wireless links lack positions; all of them are named.
    """
    radio = Radio.from_section(context.section("rf"))
    terms = Terms(
        same_slot_collisions=same_slot_collisions,
        hidden_loss=hidden_loss,
        joint_interference=joint_interference,
        joint_chains=joint_chains,
        helpers_by_stage=helpers_by_stage,
        ack_loss=ack_loss,
        silence=silence,
        energy_sensing=energy_sensing,
        far_noise=far_noise,
        dead_below_threshold=simulator_artefacts,
        lost_signal_field=simulator_artefacts,
    )
    kind = CsmaSpatialRoutesModel if relaying else CsmaSpatialModel
    return context.cached(
        ("ncsim_wifi.csma_spatial", radio, radio.draws_from(context.seed), terms, relaying),
        lambda: kind(context, radio, terms),
    )


def plant_of(context: BuildContext, radio: Radio, terms: Terms) -> tuple[Plant, IntArray]:
    """Return the radio links of a network, and the place of each link among them or -1."""
    network = context.network
    on_air = [index for index, link in enumerate(network.links) if is_on_air(link)]
    require_positions(network, on_air, "interference csma_spatial")
    signals = propagation(context, radio)
    rates_Mbps = signals.rate_Mbps[on_air]
    settings = Settings(
        noise_dBm=radio.noise_floor_dBm,
        sensing_dBm=radio.cca_threshold_dBm,
        preamble_dBm=radio.cca_threshold_dBm,
        rts_cts=radio.rts_cts,
        terms=terms,
    )
    place = np.full(len(network.links), -1)
    place[on_air] = np.arange(len(on_air))
    plant = Plant(
        tuple(network.links[index].id for index in on_air),
        np.array(network.sources, np.int64)[on_air],
        np.array(network.targets, np.int64)[on_air],
        schemes_of(rates_Mbps, signals.signal_dBm[on_air], radio),
        rates_Mbps,
        signals.power_dBm,
        settings,
    )
    return plant, place


def schemes_of(rates_Mbps: FloatArray, signal_dBm: FloatArray, radio: Radio) -> IntArray:
    """Return the hazard curve of each link: that of its rate, or of a lower one its SNR allows.

    The two differ only for links whose bandwidth the scenario states.
    """
    table = rate_table(radio)
    by_rate = np.searchsorted(table.rate_Mbps, rates_Mbps * (1.0 + RATE_TOLERANCE), side="right")
    ratio_dB = signal_dBm - radio.noise_floor_dBm
    by_ratio = np.searchsorted(table.snr_min_dB, ratio_dB, side="right")
    highest = len(hazard_table().ratio_dB) - 1
    return np.asarray(np.clip(np.minimum(by_rate, by_ratio) - 1, 0, highest))


class CsmaSpatialModel(InterferenceModel):
    """Gives each link its saturated goodput among the active ones, over that alone.

    Links that cannot influence each other are solved apart, and every set only once.

    Source: docs/csma-spatial.md.

    Args:
        context: Network.
        radio: Radio parameters.
        terms: Which effects count.
    """

    def __init__(self, context: BuildContext, radio: Radio, terms: Terms) -> None:
        self._plant, self._place = plant_of(context, radio, terms)
        self._solved = ModelCache(MAX_SOLVED_SETS)
        self._coupled = self._plant.is_coupled
        self._part_of: dict[LinkIndex, frozenset[LinkIndex]] = {}
        for part in connected_components(self._coupled):
            members = frozenset(np.flatnonzero(self._place >= 0)[part].tolist())
            self._part_of |= dict.fromkeys(members, members)

    @override
    def factors(self, links: Sequence[LinkIndex], active: Collection[LinkIndex]) -> FloatArray:
        factor: dict[int, float] = {}
        places = np.array(sorted(int(self._place[i]) for i in active if self._place[i] >= 0), int)
        asked = {int(self._place[link]) for link in links}
        for part in connected_components(self._coupled[np.ix_(places, places)]):
            members = frozenset(places[part].tolist())
            if members & asked:
                factor |= self._solved.get_or_build(members, partial(self._solve, members))
        return np.array([factor.get(int(self._place[link]), 1.0) for link in links])

    def _solve(self, places: frozenset[int]) -> dict[int, float]:
        """Return the factor of each link of a set."""
        in_order = self._plant.in_order(sorted(places))
        if len(in_order) == 1:
            return dict.fromkeys(in_order, 1.0)
        goodput_MBps = saturated_goodputs_MBps(self._plant, in_order)
        solo_MBps = self._plant.solo_MBps[in_order]
        usable = solo_MBps > 0.0
        factor = np.where(usable, goodput_MBps / np.where(usable, solo_MBps, 1.0), 1.0)
        return dict(zip(in_order, np.clip(factor, 0.0, 1.0).tolist(), strict=True))

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        reached = set(changed)
        for link in changed:
            if link in self._part_of:
                reached |= self._part_of[link]
        return reached

    @override
    def competition(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> Sequence[Competition]:
        return [self._competition(link, active) for link in links]

    def _competition(self, link: LinkIndex, active: Collection[LinkIndex]) -> Competition:
        plant, place = self._plant, int(self._place[link])
        others = [int(self._place[i]) for i in active if i != link and self._place[i] >= 0]
        if place < 0 or not others:
            return Competition()
        source = plant.source[others]
        at_sender_dBm = plant.power_dBm[source, plant.source[place]]
        sensed = (at_sender_dBm >= plant.settings.sensing_dBm) | (source == plant.source[place])
        heard = plant.power_mW[source, plant.target[place]] > 0.0
        return Competition(int(sensed.sum()), int((heard & ~sensed).sum()))


class CsmaSpatialRoutesModel(CsmaSpatialModel):
    """Gives transfers over several hops what relaying leaves them.

    Transfers that cannot influence each other are solved apart, and every set only once.

    Source: docs/csma-spatial.md; docs/decisions/0001-route-rates.md.

    Args:
        context: Network.
        radio: Radio parameters.
        terms: Which effects count.
    """

    decides_routes = True

    def __init__(self, context: BuildContext, radio: Radio, terms: Terms) -> None:
        super().__init__(context, radio, terms)
        network = context.network
        self._paths = Paths(self._plant, self._place.tolist(), network.bandwidth_MBps)
        self._answers = ModelCache(MAX_SOLVED_SETS)

    @override
    def route_rates(self, routes: Sequence[Route]) -> RouteRates:
        in_order = sorted(routes)
        answer: dict[Route, tuple[float, LinkIndex]] = {}
        for part in connected_components(self._are_coupled(in_order)):
            together = tuple(in_order[at] for at in part.tolist())
            answer |= self._answers.get_or_build(together, partial(self._decided, together))
        rates_MBps, decisive = zip(*(answer[route] for route in routes), strict=True)
        return RouteRates(np.array(rates_MBps), decisive)

    def _are_coupled(self, routes: Sequence[Route]) -> BoolArray:
        """Return which transfers share a link or reach each other by radio, (routes, routes)."""
        used = sorted({link for route in routes for link in route})
        column = {link: at for at, link in enumerate(used)}
        uses = np.zeros((len(routes), len(used)), np.bool_)
        for row, route in enumerate(routes):
            uses[row, [column[link] for link in route]] = True
        places = self._place[used]
        related = np.eye(len(used), dtype=np.bool_)
        on_air = np.flatnonzero(places >= 0)
        related[np.ix_(on_air, on_air)] |= self._coupled[np.ix_(places[on_air], places[on_air])]
        return np.asarray(uses @ related @ uses.T)

    def _decided(self, routes: tuple[Route, ...]) -> dict[Route, tuple[float, LinkIndex]]:
        """Return rate and decisive link of transfers that influence each other."""
        if all(len(route) == 1 for route in routes):
            return self._saturated(routes)
        return self._paths.rates(routes)

    def _saturated(self, routes: tuple[Route, ...]) -> dict[Route, tuple[float, LinkIndex]]:
        """Return rates of transfers of one hop each: what their links get, shared equally."""
        links = [link for (link,) in dict.fromkeys(routes)]
        factors = self.factors(links, links).tolist()
        return {
            (link,): (
                self._paths.bandwidth_MBps[link] * factor / routes.count((link,)),
                link,
            )
            for link, factor in zip(links, factors, strict=True)
        }
