"""What runs mean: numbers, statistics and explanations, all recomputable from traces alone.

``summary`` describes one run, ``statistics`` many, ``explanation`` says where the time of a run
went, and ``comparison`` what changed between two.
"""

from ncsim_core.metrics.schema import metrics_schema
from ncsim_core.metrics.summary import compute_metrics

__all__ = ["compute_metrics", "metrics_schema"]
