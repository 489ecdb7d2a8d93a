"""What stays the same in a scene, as compiled functions read it.

Records by row instead of arrays by field: numba counts references to every array that it is handed,
and takes as long to compile that as all else.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ncsim_wifi.quantities import BoolArray, FloatArray, IntArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.compiled.occupancy import Graph, graph_of
from ncsim_wifi.spatial.energy import Silencing
from ncsim_wifi.spatial.hazard import hazard_grid
from ncsim_wifi.spatial.joint import JointStages
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.statics import Statics

Records = NDArray[Any]
"""An array of records, ``rows[at].field``."""

Layout = np.dtype[np.void]


def layout(*, by_stage: str = "", **fields: str) -> Layout:
    """Return the layout of records, from the names of their fields by type.

    Args:
        by_stage: Fields that hold a number for each back-off stage.
        fields: Numbers.
    """
    columns: list[tuple[object, ...]] = [
        (name, kind) for kind, names in fields.items() for name in names.split()
    ]
    columns += [(name, "f8", (STAGES,)) for name in by_stage.split()]
    return np.dtype((np.record, columns))


LINK = layout(
    i8="station hazard_row",
    f8="on_air_us overhead_us protected_us ack_us signal_dBm noise_hazard",
    bool="is_alive",
)
MEETING = layout(
    f8="same_slot_loss far_mW deaf_to_ack answered_us unheard noticed_us silenced exposed"
    " kill own_kill",
)
"""What a station and a link do to each other; the last four under RTS/CTS."""

OTHER = layout(i8="link station group", f8="harm")
PAIR = layout(i8="one two")
HARM = layout(i8="one two", f8="kill")
ACK = layout(i8="one two relation back", f8="kill window_us later_us")
HELPED = layout(i8="relation own station", f8="protected_us")
RELATION = layout(
    i8="link station own group",
    bool="is_strong has_company stops_at_cts locks by_cts by_cts_only",
    f8="alone_half_kill alone_kill window_us noticed_us protection_ends",
    by_stage="by_cts_survives by_cts_missed",
)
"""See ``Hostile`` and ``Statics``."""


class Constants(NamedTuple):
    """Numbers of the settings."""

    gain: float
    stage_gain: float
    energy_tail_us: float
    ack_extension_kill: float
    overlap_scale: float
    noise_mW: float
    longest_us: float
    rts_cts: bool
    same_slot_collisions: bool
    silence: bool
    helpers_by_stage: bool
    has_far: bool


class Air(NamedTuple):
    """Links and stations, and what they do to each other.

    Args:
        links: Records ``LINK``.
        meetings: Records ``MEETING``, shape (links, stations).
        senses: 1 where stations sense each other.
        by_power: Whether they do by received power.
        graph: Components of the sensing graph.
        others: Harmful stations beyond the nearest, records ``OTHER``.
        link_of_group: The link of each group of these.
        acks: Records ``ACK``: the link that suffers, the one whose acknowledgements do harm; see
            ``AckRelations``.
        spoilt: Who may begin unawares, under RTS/CTS; see ``Unread``.
        grid: ln h of all schemes, one behind the other.
    """

    links: Records
    meetings: Records
    senses: FloatArray
    by_power: BoolArray
    graph: Graph
    others: Records
    link_of_group: IntArray
    acks: Records
    spoilt: BoolArray
    grid: FloatArray


class Hidden(NamedTuple):
    """Hostile relations.

    Args:
        relations: Records ``RELATION``.
        link_of_group: The link of each group.
        partner: See ``Hostile``.
        partner_kill: See ``Hostile``.
        every: Pairs of relations; see ``Rivals``.
        earlier: Those of which the second belongs to an earlier group.
        answers: Records ``HARM``: relation, link of its interferer, harm of an acknowledgement.
        chain_of: Relations with a chain, and the side that they are part of.
        station_of_side: Whose stages each side of a chain is.
    """

    relations: Records
    link_of_group: IntArray
    partner: IntArray
    partner_kill: FloatArray
    every: Records
    earlier: Records
    answers: Records
    chain_of: Records
    station_of_side: IntArray


class Helpers(NamedTuple):
    """The relations that may act together with others; records ``HELPED``, and see ``Helped``."""

    helped: Records
    helper: IntArray
    helper_relation: IntArray
    kill: FloatArray
    omega: FloatArray


class Energy(NamedTuple):
    """Who is silenced by summed power."""

    station: IntArray
    member: IntArray
    silencing: Silencing


class Tables(NamedTuple):
    """Everything that stays the same in a scene."""

    constants: Constants
    air: Air
    hidden: Hidden
    helpers: Helpers
    energy: Energy


def tables_of(scene: Scene, statics: Statics, joint: JointStages) -> Tables:
    """Return the tables of a scene."""
    return Tables(
        _constants(scene, statics),
        _air(scene, statics),
        _hidden(statics, joint),
        _helpers(statics),
        Energy(statics.energy.station, in_rows(statics.energy.member), statics.silencing),
    )


def records(shape: int | tuple[int, ...], kind: Layout, **values: NDArray[np.generic]) -> Records:
    """Return records with some values, 0 elsewhere."""
    made = np.zeros(shape, kind)
    for name, value in values.items():
        made[name] = value
    return made


def in_rows(values: NDArray[Any]) -> NDArray[Any]:
    """Return an array row by row in memory, as compiled functions have been told it is."""
    return np.ascontiguousarray(values)


def _constants(scene: Scene, statics: Statics) -> Constants:
    settings, terms = scene.settings.approximations, scene.settings.terms
    return Constants(
        settings.gain,
        settings.stage_gain,
        settings.energy_tail_us,
        settings.ack_extension_kill,
        settings.overlap_scale,
        scene.plant.noise_mW,
        statics.longest_us,
        scene.settings.rts_cts,
        terms.same_slot_collisions,
        terms.silence,
        terms.helpers_by_stage,
        bool(statics.far_mW.any()),
    )


def _air(scene: Scene, statics: Statics) -> Air:
    others, acks, handshakes = statics.others, statics.acks, statics.handshakes
    return Air(
        _links(scene),
        _meetings(scene, statics),
        statics.senses,
        scene.hears_by_power,
        graph_of(statics.occupancy),
        records(
            len(others.link),
            OTHER,
            link=others.link,
            station=others.station,
            group=others.group,
            harm=others.harm,
        ),
        others.link_of_group,
        records(
            len(acks.link),
            ACK,
            one=acks.link,
            two=acks.other,
            relation=acks.data,
            back=acks.back,
            kill=acks.kill,
            window_us=acks.window_us,
            later_us=acks.later_us,
        ),
        np.zeros((0, 0, 0), np.bool_) if handshakes is None else in_rows(handshakes.unread.spoilt),
        hazard_grid().reshape(-1),
    )


def _links(scene: Scene) -> Records:
    return records(
        len(scene.links),
        LINK,
        station=scene.station,
        hazard_row=scene.scheme * hazard_grid().shape[1],
        on_air_us=scene.on_air_us,
        overhead_us=scene.overhead_us,
        protected_us=scene.protected_us,
        ack_us=scene.ack_us,
        signal_dBm=scene.signal_dBm,
        noise_hazard=scene.plant.noise_hazard[scene.links],
        is_alive=scene.is_alive,
    )


def _meetings(scene: Scene, statics: Statics) -> Records:
    handshakes = statics.handshakes
    meetings = records(
        (len(scene.links), scene.station_count),
        MEETING,
        same_slot_loss=statics.same_slot_loss,
        far_mW=statics.far_mW,
        deaf_to_ack=statics.deaf_to_ack,
        answered_us=statics.heard.answered_us,
        unheard=statics.heard.unheard,
        noticed_us=statics.heard.noticed_us,
    )
    if handshakes is not None:
        unread = handshakes.unread
        meetings["silenced"], meetings["exposed"] = handshakes.silenced, unread.exposed
        meetings["kill"], meetings["own_kill"] = unread.kill, unread.own_kill
    return meetings


def _hidden(statics: Statics, joint: JointStages) -> Hidden:
    hostile, answers = statics.hostile, statics.answers_of
    every, earlier = statics.rivals
    return Hidden(
        _relations(statics),
        hostile.link_of_group,
        in_rows(hostile.partner),
        in_rows(hostile.partner_kill),
        records(len(every[0]), PAIR, one=every[0], two=every[1]),
        records(len(earlier[0]), PAIR, one=earlier[0], two=earlier[1]),
        records(
            len(answers.link),
            HARM,
            one=answers.relation,
            two=answers.link,
            kill=statics.answer_kill,
        ),
        records(len(joint.relations), PAIR, one=joint.relations, two=joint.side[joint.relations]),
        joint.station,
    )


def _relations(statics: Statics) -> Records:
    hostile, handshakes = statics.hostile, statics.handshakes
    relations = records(
        len(hostile),
        RELATION,
        link=hostile.link,
        station=hostile.station,
        own=statics.own,
        group=hostile.group,
        is_strong=hostile.is_strong,
        has_company=hostile.is_member_of_several,
        stops_at_cts=statics.stops_at_cts,
        locks=hostile.locks,
        by_cts_only=hostile.by_cts_only,
        alone_half_kill=statics.alone_half_kill,
        alone_kill=statics.alone_kill,
        window_us=statics.window_us,
        protection_ends=statics.protection_ends,
    )
    if handshakes is not None:
        relations["noticed_us"], relations["by_cts"] = handshakes.noticed_us, handshakes.by_cts
        relations["by_cts_survives"] = handshakes.by_cts_survives
        relations["by_cts_missed"] = handshakes.by_cts_missed
    return relations


def _helpers(statics: Statics) -> Helpers:
    helped = statics.helped
    return Helpers(
        records(
            len(helped.own),
            HELPED,
            relation=statics.hostile.with_helpers,
            own=helped.own,
            station=helped.station,
            protected_us=helped.protected_us,
        ),
        in_rows(helped.helper),
        in_rows(statics.helper_relation),
        in_rows(helped.kill),
        in_rows(helped.omega),
    )
