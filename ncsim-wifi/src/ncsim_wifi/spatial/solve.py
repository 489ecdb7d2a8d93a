"""The fixed point: attempt rates, occupancy, losses and back-off stages, a fixed number of times.

A fixed number of steps from a cold start makes the result a function of the active set alone.

Source: MODEL 3 and 6.
"""

import numpy as np

from ncsim_wifi.mac.timing import RTS_us, SLOT_us
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.acks import Overlapped, answers_survival, heard_answers
from ncsim_wifi.spatial.artefacts import Senders, field_survival
from ncsim_wifi.spatial.attempts import Attempts, Contenders, Exchange, attempts_of
from ncsim_wifi.spatial.backoff import (
    MEAN_COUNTS,
    STAGES,
    attempt_probability,
    mean_count,
    visits_per_packet,
)
from ncsim_wifi.spatial.collisions import base_success
from ncsim_wifi.spatial.elementary import exp, log
from ncsim_wifi.spatial.energy import silenced_by
from ncsim_wifi.spatial.handshake import BEFORE_CTS_us, unaware_starts, unaware_survival
from ncsim_wifi.spatial.joint import JointStages, RelationRates
from ncsim_wifi.spatial.losses import (
    HiddenLoss,
    Traffic,
    by_own_stage,
    hidden_loss,
)
from ncsim_wifi.spatial.near import far_noise_survival, others_survival
from ncsim_wifi.spatial.occupancy import Occupancy
from ncsim_wifi.spatial.overlap import LARGEST_ON, LEAST_ON
from ncsim_wifi.spatial.plant import PAYLOAD_MB_us_per_s
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.silence import Silence, silence_of
from ncsim_wifi.spatial.statics import Statics, statics_of
from ncsim_wifi.spatial.sums import products_by, row_products, row_sums, sums_by

STEPS_WITH_CHAINS = 4  # then every second one (MODEL 3.10)
LEAST_ACTIVITY = 1e-12


class FixedPoint:
    """The iteration on one scene.

    Args:
        scene: The active links.
        statics: Those of the scene, where they are known.
    """

    def __init__(self, scene: Scene, statics: Statics | None = None) -> None:
        self._scene = scene
        self._statics: Statics = statics or statics_of(scene)
        self._joint = JointStages(scene, self._statics.hostile)
        links, stations = len(scene.links), scene.station_count
        self._stages = np.zeros((stations, STAGES))
        self._stages[:, 0] = 1.0
        self._link_stages = np.zeros((links, STAGES))
        self._link_stages[:, 0] = 1.0
        self._attempts = 1.0 / scene.link_of_station.sum(axis=1)[scene.station]
        self._loss = np.zeros(links)
        self._answered = np.ones(links)
        self._heard = np.ones(links)
        self._silenced = np.zeros(stations)
        self._activity = np.ones(stations)
        self._packets = np.ones(links)
        self._clear = np.ones((stations, stations))
        self._blocked = np.zeros(stations)
        self._eager = np.ones((len(self._statics.hostile), STAGES))
        overhead_us = scene.station_sums(self._attempts * scene.overhead_us)
        self._silence = Silence(overhead_us, np.zeros((stations, stations)))

    def goodputs_MBps(self) -> FloatArray:
        """Iterate, and return the goodput of each link of the scene."""
        rate_per_us = self._advance(0, self._scene.settings.approximations.iterations)
        delivered = rate_per_us[self._scene.station] * self._attempts * (1.0 - self._loss)
        return np.where(self._scene.is_alive, PAYLOAD_MB_us_per_s * delivered, 0.0)

    def step(self, number: int) -> FloatArray:
        """Go one step; return the packets per us that each station could deliver, by link.

        That is what the link would get if its station served no other and always had a frame.
        """
        rate_per_us = self._advance(number, number + 1) / self._activity
        able_per_us = rate_per_us[self._scene.station] * (1.0 - self._loss)
        return np.where(self._scene.is_alive, able_per_us, 0.0)

    def load(self, activity: FloatArray, packets: FloatArray) -> None:
        """Set how busy stations are, and how they divide their packets among links.

        Args:
            activity: alpha, part of the time in which a station has a frame, above 0.
            packets: Packets per time of each link, up to a factor per station.
        """
        self._activity[:] = activity
        self._packets[:] = packets

    def _advance(self, first: int, stop: int) -> FloatArray:
        """Go some steps; return R_u of the last."""
        rate_per_us = np.zeros(self._scene.station_count)
        for number in range(first, stop):
            rate_per_us = self._step(with_chains=number < STEPS_WITH_CHAINS or number % 2 == 0)
        return rate_per_us

    def _step(self, *, with_chains: bool) -> FloatArray:
        """Go one step; return R_u."""
        times = self._exchange()
        count = mean_count(self._stages)
        tau = attempt_probability(count)
        attempts = attempts_of(
            Contenders(
                self._statics.senses,
                tau,
                self._clear,
                self._able(),
                self._scene.settings.rts_cts,
            ),
            times,
        )
        occupancy = self._statics.occupancy(np.maximum(attempts.activity, LEAST_ACTIVITY))
        gain = self._scene.settings.approximations.gain
        self._clear = gain * np.minimum(occupancy.clear, 1.0) + (1.0 - gain) * self._clear
        traffic = self._traffic(count, attempts, occupancy, times)
        fresh = silence_of(
            self._scene, self._statics.heard, self._clear, self._attempts, self._answered
        )
        self._silence = Silence(
            *(
                gain * new + (1.0 - gain) * old
                for new, old in zip(fresh, self._silence, strict=True)
            )
        )
        self._learn(traffic, attempts, with_chains=with_chains)
        return traffic.rate_per_us

    def _able(self) -> FloatArray:
        """Return how often stations have a frame, and neither summed power nor a CTS stops them."""
        free = (1.0 - self._blocked) * (1.0 - np.minimum(self._silenced, LARGEST_ON))
        return self._activity * free

    def _exchange(self) -> Exchange:
        """Return T_u, ovh_u and the silence after frames, averaged over links (MODEL 3.1)."""
        scene, on_air_us = self._scene, self._scene.on_air_us
        if scene.settings.rts_cts:
            on_air_us = self._answered * on_air_us + (1.0 - self._answered) * RTS_us
        on_air_us = scene.station_sums(self._attempts * on_air_us)
        overhead_us = scene.station_sums(self._attempts * scene.overhead_us)
        return Exchange(on_air_us, overhead_us, *self._silence, on_air_us + self._silence.mean_us)

    def _traffic(
        self, count: FloatArray, attempts: Attempts, occupancy: Occupancy, times: Exchange
    ) -> Traffic:
        """Return R_u, D_u and cyc_u (MODEL 3.3)."""
        rate_per_us = attempts.rate_per_us * occupancy.idle
        base_us = times.on_air_us + times.overhead_us
        count_us = np.maximum(SLOT_us, (1.0 / rate_per_us - base_us) / count)
        cycle_us = base_us[:, None] + MEAN_COUNTS * count_us[:, None]
        return Traffic(
            occupancy.on,
            attempts.same_slot,
            attempt_probability(count),
            rate_per_us,
            self._stages,
            cycle_us,
            times,
            self._loss,
            self._attempts,
            self._scene.station_sums(self._attempts * self._answered),
            occupancy.on * (times.on_air_us / times.busy_us),
            self._link_stages,
        )

    def _learn(self, traffic: Traffic, attempts: Attempts, *, with_chains: bool) -> None:
        """Bring losses, chains and stages up to date (MODEL 3.5 to 3.11)."""
        statics = self._statics
        scene, sending = self._scene, traffic.sending
        spared = far_noise_survival(scene, statics.far_mW, sending)
        base = base_success(scene, spared, attempts.same_slot, statics.sensed_loss)
        if len(statics.others.link):
            base = base * others_survival(scene, statics.others, sending, traffic.times.on_air_us)
        base = base * self._aware(traffic) * self._fields_survival(traffic, attempts)
        gates = self._gates(traffic)
        if len(statics.hostile):
            hidden = hidden_loss(scene, statics, traffic, gates, self._eager)
            base = base * self._partner_collisions(traffic, gates[1])
            base = base * self._ack_survival(traffic, hidden)
            success, parts = self._success(base, hidden, hidden.survives, hidden.grows)
            if with_chains and self._joint.count:
                self._joint.update(
                    self._attempts,
                    success,
                    parts,
                    RelationRates(hidden.survives, hidden.hit, hidden.share, hidden.grows),
                    traffic.cycle_us,
                )
                success, _ = self._success(base, hidden, hidden.survives, hidden.grows)
                self._learn_eagerness(traffic, hidden)
            self._learn_handshake(traffic, hidden)
        else:
            base = base * self._ack_survival(traffic, None)
            success = np.repeat(base[:, None], STAGES, axis=1)
        self._visit(success)

    def _fields_survival(self, traffic: Traffic, attempts: Attempts) -> FloatArray | float:
        """Return what stations that lost a signalling field leave of frames (an artefact)."""
        fields = self._statics.fields
        if fields is None:
            return 1.0
        count = mean_count(self._stages)
        senders = Senders(
            traffic.rate_per_us, attempts.rate_per_us, traffic.times.on_air_us, count, self._clear
        )
        return field_survival(self._scene, fields, senders)

    def _aware(self, traffic: Traffic) -> FloatArray | float:
        """Return what stations that missed an RTS leave of frames, theirs and others'."""
        scene, handshakes = self._scene, self._statics.handshakes
        if handshakes is None:
            return 1.0
        unread = handshakes.unread
        starts = unaware_starts(unread, traffic.sending, self._clear, traffic.tau)
        return unaware_survival(
            scene, unread, starts, self._answered, self._attempts, traffic.rate_per_us
        )

    def _learn_eagerness(self, traffic: Traffic, hidden: HiddenLoss) -> None:
        """Update how often interferers attempt while a sender is in each stage (MODEL 3.7)."""
        if not self._scene.settings.terms.helpers_by_stage:
            return
        rate_per_us = 1.0 / traffic.cycle_us[self._statics.hostile.station]
        mean_per_us = row_sums(hidden.alone * rate_per_us)
        by_stage_per_us = self._joint.expected(hidden.alone, rate_per_us)
        self._eager = by_stage_per_us / mean_per_us[:, None]

    def _learn_handshake(self, traffic: Traffic, hidden: HiddenLoss) -> None:
        """Update which RTS are answered, and who is silenced by CTS of hidden receivers."""
        scene, statics = self._scene, self._statics
        handshakes = statics.handshakes
        if handshakes is None:
            return
        gain = scene.settings.approximations.gain
        by_stage, _ = self._success(self._heard, hidden, hidden.answered, np.ones_like(hidden.hit))
        fresh = row_sums(self._link_stages * by_stage)
        self._answered = gain * fresh + (1.0 - gain) * self._answered
        after_cts_us = (scene.on_air_us - BEFORE_CTS_us + scene.overhead_us) * self._answered
        silenced_us = handshakes.silenced * after_cts_us[:, None]
        heard_us = scene.station_means(self._attempts, silenced_us)  # (w, u)
        on = np.clip(traffic.on * (heard_us / traffic.times.busy_us[:, None]).T, 0.0, LARGEST_ON)
        silenced = 1.0 - row_products(1.0 - on)
        self._silenced += gain * (silenced - self._silenced)

    def _visit(self, success: FloatArray) -> None:
        """Update stages, attempt shares and losses (MODEL 3.11)."""
        gain = self._scene.settings.approximations.stage_gain
        visits = visits_per_packet(np.minimum(np.maximum(success, 0.0), 1.0))
        fresh = visits / row_sums(visits)[:, None]
        self._link_stages = gain * fresh + (1.0 - gain) * self._link_stages
        per_packet = self._packets / self._link_stages[:, 0]
        own = self._scene.station_sums(per_packet)
        self._attempts = per_packet / own[self._scene.station]
        self._stages = self._scene.station_means(self._attempts, self._link_stages)
        self._loss = 1.0 - row_sums(self._link_stages * success)

    def _success(
        self, base: FloatArray, hidden: HiddenLoss, survives: FloatArray, grows: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return tot_l(a), and sbar_r(a) of each relation (MODEL 3.9)."""
        hostile = self._statics.hostile
        parts = by_own_stage(self._joint.expected(hidden.alone, survives), grows)
        factors = np.maximum(parts, 1e-12)
        some = hostile.of_several
        if len(some):
            factors[some] = exp(hidden.phi[some, None] * log(factors[some]))
        whole = np.ones((len(base), STAGES))
        whole[hostile.links] = np.multiply.reduceat(factors, hostile.link_starts)
        whole = np.minimum(1.0, whole * hidden.correction[:, None])
        return base[:, None] * whole, parts

    def _gates(self, traffic: Traffic) -> tuple[FloatArray, FloatArray]:
        """Return al and be of each relation, and update B (MODEL 3.6)."""
        statics, settings = self._statics, self._scene.settings.approximations
        count = len(statics.hostile)
        sets = statics.energy
        if not len(sets.station):
            return np.ones(count), np.ones(count)
        times = traffic.times
        stretch = (times.on_air_us + settings.energy_tail_us) / times.busy_us
        on = traffic.on[sets.station[:, None], sets.member] * stretch[sets.member]
        on = np.minimum(np.maximum(on, LEAST_ON), LARGEST_ON)
        found = silenced_by(statics.silencing, on)
        fresh = found.blocked
        self._blocked[sets.station] += settings.gain * (fresh - self._blocked[sets.station])
        np.minimum(self._blocked, LARGEST_ON, out=self._blocked)
        return found.before, 1.0 - (1.0 - found.during) * statics.protection_ends

    def _partner_collisions(self, traffic: Traffic, during: FloatArray) -> FloatArray:
        """Return what same-slot collisions with partners by summed power leave (MODEL 3.6)."""
        hostile = self._statics.hostile
        meets = traffic.tau[hostile.station] * self._clear[self._statics.own, hostile.station]
        lost = meets * (1.0 - during) * self._statics.relation_loss
        spared = 1.0 - np.minimum(lost, LARGEST_ON)
        return products_by(hostile.link, spared, len(self._scene.links))

    def _ack_survival(self, traffic: Traffic, hidden: HiddenLoss | None) -> FloatArray:
        """Return what acknowledgements of hidden links leave of frames (MODEL 3.9)."""
        scene, acks = self._scene, self._statics.acks
        kill = self._kill_while_sending(hidden)
        self._heard = self._heard_answers(traffic, kill)
        if not len(acks.link):
            return self._heard
        sent = traffic.rate_per_us[scene.station] * self._attempts * (1.0 - self._loss)
        if scene.settings.rts_cts:
            sent = sent * 2.0  # each data frame is answered by a CTS before and an ACK after
        met = self._overlapped(hidden, kill)
        spared = answers_survival(acks, sent[acks.other], met)
        return self._heard * products_by(acks.link, np.maximum(1e-12, spared), len(scene.links))

    def _kill_while_sending(self, hidden: HiddenLoss | None) -> FloatArray:
        """Return the part of frames that each relation destroys while its station sends."""
        hostile = self._statics.hostile
        if hidden is None:
            return np.zeros(0)
        if not self._scene.settings.rts_cts:
            return hidden.kill
        return np.where(hostile.by_cts_only, self._statics.alone_kill, hidden.kill)

    def _heard_answers(self, traffic: Traffic, kill: FloatArray) -> FloatArray:
        """Return the part of acknowledgements that senders receive (MODEL 3.9)."""
        scene, hostile, sending = self._scene, self._statics.hostile, traffic.sending
        spared = np.ones((len(scene.links), scene.station_count))
        spared[hostile.link, hostile.station] = 1.0 - kill
        handshakes = self._statics.handshakes
        if handshakes is not None:  # a CTS stops the sender too
            part = (self._attempts * self._answered)[:, None] * handshakes.silenced
            sending = sending * (1.0 - sums_by(scene.station, part, scene.station_count)).T
        return heard_answers(self._statics.deaf_to_ack, sending[scene.station] * spared)

    def _overlapped(self, hidden: HiddenLoss | None, kill: FloatArray) -> Overlapped:
        """Return what becomes of frames that relations may overlap, on average over stages."""
        every, settings = np.ones(len(kill)), self._scene.settings
        if hidden is None:
            return Overlapped(every, every, every > 1.0, every)
        hit, survives = (row_sums(hidden.alone * each) for each in (hidden.hit, hidden.survives))
        if settings.rts_cts:
            return Overlapped(hit, survives, every > 1.0, 1.0 - kill)
        is_prolonged = kill >= settings.approximations.ack_extension_kill
        return Overlapped(hit, survives, is_prolonged, every)
