"""Networks and DAGs made by rule: the paper's study inputs, and common shapes."""
