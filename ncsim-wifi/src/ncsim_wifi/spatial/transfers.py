"""What transfers over several hops get while others are under way.

Alone, a transfer gets what the clique rule gives (``relay.py``). Others slow it as they do in the
coupled model: every station is active as much of the time as it needs to pass on what it
receives, and for each transfer one hop is always busy. Only the ratio of the rates with and
without the others is taken from it, so that both limits are exact: one transfer alone, and
transfers of one hop each, which are saturated.

Source: MODEL 5; docs/decisions/0001-route-rates.md.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

import numpy as np
from ncsim_core.context import ModelCache
from ncsim_core.network import LinkIndex, Route

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.forms import form_for
from ncsim_wifi.spatial.plant import PAYLOAD_MB_us_per_s, Plant
from ncsim_wifi.spatial.relay import clique_limits_MBps
from ncsim_wifi.spatial.scene import Scene, scene_of
from ncsim_wifi.spatial.sharing import Sharing
from ncsim_wifi.spatial.statics import Statics, statics_of

STEPS = 10  # after which rates are off their limits by 4 % in the median, one in ten by 14 %
LEAST_BUSY = 1e-3
MAX_KEPT_SCENES = 16  # up to a few MB each


class RouteAlone(NamedTuple):
    """A transfer that has the network for itself.

    Args:
        rate_MBps: What it gets, by the clique rule.
        decisive: The slowest hop of the tightest clique.
    """

    rate_MBps: float
    decisive: LinkIndex


@dataclass(frozen=True)
class Paths:
    """The links of a network, as routes use them.

    Args:
        plant: Those on the radio.
        place: The place of each link in the plant, -1 for wired ones.
        bandwidth_MBps: Clean bandwidth of each link.
        known: What routes get alone.
        coupled_MBps: What the coupled model makes of these, where that was asked.
        scenes: Latest scenes; transfers come and go on links that others use anyway.
    """

    plant: Plant
    place: Sequence[int]
    bandwidth_MBps: Sequence[float]
    known: dict[Route, RouteAlone] = field(default_factory=dict, compare=False)
    coupled_MBps: dict[Route, float] = field(default_factory=dict, compare=False)
    scenes: ModelCache = field(default_factory=partial(ModelCache, MAX_KEPT_SCENES), compare=False)

    def scene(self, places: tuple[int, ...]) -> tuple[Scene, Statics]:
        """Return the scene of some places of the plant, and what stays the same in it."""

        def built() -> tuple[Scene, Statics]:
            scene = scene_of(self.plant, places)
            return scene, statics_of(scene)

        return self.scenes.get_or_build(places, built)

    def route_alone(self, route: Route) -> RouteAlone:
        """Return what a transfer gets that has the network for itself, worked out once."""
        if route not in self.known:
            self.known[route] = self._route_alone(route)
        return self.known[route]

    def _route_alone(self, route: Route) -> RouteAlone:
        limits = [(self.bandwidth_MBps[link], at) for at, link in enumerate(route)]
        on_air = [at for at, link in enumerate(route) if self.place[link] >= 0]
        if min(limits)[0] > 0.0:
            clean_MBps = [limits[at][0] for at in on_air]
            hops = [self.place[route[at]] for at in on_air]
            for limit_MBps, clique in clique_limits_MBps(self.plant, hops, clean_MBps):
                slowest = min(clique, key=lambda hop: (clean_MBps[hop], hop))
                limits.append((limit_MBps, on_air[slowest]))
        rate_MBps, at = min(limits)
        return RouteAlone(rate_MBps, route[at])

    def coupled_alone_MBps(self, route: Route) -> float:
        """Return what the coupled model makes of a transfer alone, worked out once."""
        if len(route) == 1:
            return self.route_alone(route).rate_MBps
        if route not in self.coupled_MBps:
            ((self.coupled_MBps[route], _),) = self.coupled([route])
        return self.coupled_MBps[route]

    def rates(self, routes: Sequence[Route]) -> dict[Route, tuple[float, LinkIndex]]:
        """Return rate and decisive link of each of several transfers that influence each other.

        Args:
            routes: Sorted; one that occurs twice stands for two transfers.
        """
        alone = {route: self.route_alone(route) for route in dict.fromkeys(routes)}
        if len(routes) == 1:
            return dict(alone)
        coupled = dict(zip(routes, self.coupled(routes), strict=True))
        answer = {}
        for route, (rate_MBps, decisive) in coupled.items():
            alone_MBps = self.coupled_alone_MBps(route)
            ratio = rate_MBps / alone_MBps if alone_MBps else 0.0
            answer[route] = (alone[route].rate_MBps * min(1.0, ratio), decisive)
        return self._within_bandwidth(routes, answer)

    def _within_bandwidth(
        self, routes: Sequence[Route], answer: Mapping[Route, tuple[float, LinkIndex]]
    ) -> dict[Route, tuple[float, LinkIndex]]:
        """Return rates scaled down where two rules together would overload a link."""
        load_MBps: dict[LinkIndex, float] = {}
        for route in routes:
            for link in route:
                load_MBps[link] = load_MBps.get(link, 0.0) + answer[route][0]
        room = {
            link: self.bandwidth_MBps[link] / total_MBps if total_MBps else 1.0
            for link, total_MBps in load_MBps.items()
        }
        return {
            route: (rate_MBps * min(1.0, *(room[link] for link in route)), decisive)
            for route, (rate_MBps, decisive) in answer.items()
        }

    def coupled(self, routes: Sequence[Route]) -> list[tuple[float, LinkIndex]]:
        """Return rates and decisive links in the coupled model.

        A fixed number of damped steps from a cold start makes them a function of the routes.

        Args:
            routes: Sorted; the answer to equal routes is equal.
        """
        used = sorted({link for route in routes for link in route})
        if not any(self.place[link] >= 0 for link in used):
            bandwidth_MBps = {link: self.bandwidth_MBps[link] for link in used}
            return Sharing(routes, {link: link for link in used}).divide(bandwidth_MBps)
        on_air = [link for link in used if self.place[link] >= 0]
        in_order = self.plant.in_order([self.place[link] for link in on_air])
        link_at = {self.place[link]: link for link in on_air}
        return _Coupled(self, routes, used, [link_at[place] for place in in_order]).rates()


class _Coupled:
    """The iteration over activities of stations and rates of transfers.

    Args:
        paths: The links.
        routes: Links of each transfer.
        used: All links in use.
        on_air: Those on the radio, in the order of the scene.
    """

    def __init__(
        self,
        paths: Paths,
        routes: Sequence[Route],
        used: Sequence[LinkIndex],
        on_air: Sequence[LinkIndex],
    ) -> None:
        self._paths, self._routes, self._on_air = paths, routes, on_air
        places = [paths.place[link] for link in on_air]
        self._scene, statics = paths.scene(tuple(places))
        solver = form_for(STEPS, len(on_air))
        self._solver = solver(self._scene, statics)
        stations = self._scene.station.tolist()
        wires = {link: -1 - link for link in used if paths.place[link] < 0}
        self._sharing = Sharing(routes, dict(zip(on_air, stations, strict=True)) | wires)
        solo_MBps = paths.plant.solo_MBps[places]
        clean_MBps = np.array([paths.bandwidth_MBps[link] for link in on_air])
        usable = solo_MBps > 0.0
        self._scale = np.where(
            usable, PAYLOAD_MB_us_per_s * clean_MBps / np.where(usable, solo_MBps, 1.0), 0.0
        )
        self._able_MBps = {link: paths.bandwidth_MBps[link] for link in wires}

    def rates(self) -> list[tuple[float, LinkIndex]]:
        """Return the rate in MB/s and the decisive link of each transfer."""
        activity = np.ones(self._scene.station_count)
        packets = np.ones(len(self._on_air))
        answer: list[tuple[float, LinkIndex]] = []
        for number in range(STEPS):
            able_MBps = self._solver.step(number) * self._scale
            self._able_MBps.update(zip(self._on_air, able_MBps.tolist(), strict=True))
            answer = self._sharing.divide(self._able_MBps)
            if number == STEPS - 1:
                break
            load_MBps = self._load_MBps(answer)
            busy = self._busy(load_MBps, able_MBps)
            activity = moved(activity, busy)
            fresh = np.maximum(load_MBps / np.maximum(self._scale, LEAST_BUSY), LEAST_BUSY**2)
            packets = moved(packets, fresh)
            self._solver.load(activity, packets)
        return answer

    def _load_MBps(self, answer: Sequence[tuple[float, LinkIndex]]) -> FloatArray:
        carried = dict.fromkeys(self._on_air, 0.0)
        for route, (rate_MBps, _) in zip(self._routes, answer, strict=True):
            for link in route:
                if link in carried:
                    carried[link] += rate_MBps
        return np.array(list(carried.values()))

    def _busy(self, load_MBps: FloatArray, able_MBps: FloatArray) -> FloatArray:
        """Return alpha, for how much of the time each station has something to send."""
        part = np.where(able_MBps > 0.0, load_MBps / np.maximum(able_MBps, 1e-300), 1.0)
        stations = np.bincount(self._scene.station, part, minlength=self._scene.station_count)
        return np.minimum(np.maximum(stations, LEAST_BUSY), 1.0)


def moved(old: FloatArray, fresh: FloatArray) -> FloatArray:
    """Return what is 11/16 of the way from old to fresh, in logarithms.

    The plain iteration oscillates. Roots give the same bits on every machine, powers do not.
    """
    return np.sqrt(fresh * np.sqrt(old * np.sqrt(fresh * np.sqrt(fresh * old))))
