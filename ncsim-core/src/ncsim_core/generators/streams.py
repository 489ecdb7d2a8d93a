"""Random draws by name, so that drawing more of one thing changes nothing else."""

import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True)
class Draws:
    """Where a generator's random numbers come from.

    Each named stream is a generator of its own: ``placement`` for positions, ``topology`` for
    which links exist, ``capacity``, and ``workload.*`` for what DAGs ask. Shadowing has a stream
    of its own in the radio model.

    Args:
        seed: 0 or more.
    """

    seed: int = 42

    def stream(self, name: str, *numbers: int) -> "np.random.Generator":
        """Return the generator of a stream from its beginning.

        Args:
            name: What is drawn.
            *numbers: Which of several alike, such as the number of a DAG; 0 or more.

        >>> Draws(1).stream("placement").random() == Draws(1).stream("placement").random()
        True
        """
        import numpy as np

        return np.random.default_rng([self.seed, zlib.crc32(name.encode()), *numbers])
