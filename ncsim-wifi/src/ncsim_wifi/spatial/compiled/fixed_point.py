"""The fixed point by compiled loops."""

import numpy as np
from typing_extensions import override

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.backoff import STAGES
from ncsim_wifi.spatial.compiled.entries import ADVANCE
from ncsim_wifi.spatial.compiled.state import LINK_STATE, STATION_STATE, State
from ncsim_wifi.spatial.compiled.tables import records, tables_of
from ncsim_wifi.spatial.scene import Scene
from ncsim_wifi.spatial.solve import FixedPoint
from ncsim_wifi.spatial.statics import Statics


class CompiledFixedPoint(FixedPoint):
    """The same iteration, all steps of which are one compiled function.

    Artefacts of simulators are not in it; with them it works with arrays.
    """

    def __init__(self, scene: Scene, statics: Statics | None = None) -> None:
        super().__init__(scene, statics)
        self._tables = tables_of(scene, self._statics, self._joint)
        self._state = self._records()

    def _records(self) -> State:
        """Return the state as records; what is read from outside becomes a view of them."""
        links = records(
            len(self._attempts),
            LINK_STATE,
            attempts=self._attempts,
            loss=self._loss,
            answered=self._answered,
            packets=self._packets,
            stages=self._link_stages,
        )
        stations = records(
            len(self._activity),
            STATION_STATE,
            activity=self._activity,
            silenced=self._silenced,
            blocked=self._blocked,
            silent_us=self._silence.mean_us,
            stages=self._stages,
        )
        self._attempts, self._loss = links["attempts"], links["loss"]
        self._packets, self._activity = links["packets"], stations["activity"]
        return State(
            links,
            stations,
            self._clear,
            self._silence.deviation_us,
            self._eager,
            np.zeros((len(self._joint.relations), STAGES, STAGES)),
            np.zeros(1, np.int64),
        )

    @override
    def _advance(self, first: int, stop: int) -> FloatArray:
        if self._statics.fields is not None:
            return super()._advance(first, stop)
        return ADVANCE(self._tables, self._state, first, stop)
