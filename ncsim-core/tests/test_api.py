"""Results as tables."""

import pytest
from ncsim_core.api import result_of
from ncsim_core.testing.worked_example import worked_example


def test_tables_of_a_result_are_frames_and_others_are_named():
    pytest.importorskip("pandas")
    simulation = worked_example()
    simulation.run()
    result = result_of(simulation)

    assert list(result.to_pandas("transfers")["source_task"]) == ["A", "B"]
    with pytest.raises(ValueError, match="no table 'task'; there are tasks, transfers and links"):
        result.to_pandas("task")
