"""What does a link offer alone?"""

from abc import ABC, abstractmethod

from ncsim_core.network import LinkRates, Network


class LinkModel(ABC):
    """Decides the clean solo goodput and latency of every link, once, before the run."""

    @abstractmethod
    def rate_links(self, network: Network) -> LinkRates:
        """Return bandwidth (MB/s) and latency (s) of each link, from 0 to ``MAX_QUANTITY``.

        Raises:
            ScenarioError: A link lacks something that the model needs, such as a bandwidth
                or the positions of its ends; all such links are named.
        """
