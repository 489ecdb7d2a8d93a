"""The interference model of a world without interference."""

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from typing_extensions import override

from ncsim_core.context import BuildContext
from ncsim_core.contracts.interference_model import (
    InterferenceModel,
    InterferenceSession,
    Unaffected,
)
from ncsim_core.network import LinkIndex

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class NoInterference(InterferenceModel):
    """Lets every link keep its clean bandwidth."""

    def __init__(self, context: BuildContext) -> None:
        del context

    @override
    def factors(
        self, links: Sequence[LinkIndex], active: Collection[LinkIndex]
    ) -> "NDArray[np.float64]":
        import numpy as np

        return np.ones(len(links))

    @override
    def reach(self, changed: Collection[LinkIndex]) -> Collection[LinkIndex]:
        return changed

    @override
    def open_session(self) -> InterferenceSession:
        return Unaffected()
