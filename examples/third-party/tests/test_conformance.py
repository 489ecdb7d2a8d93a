from ncsim_core.testing import SchedulerSuite


class TestLookahead(SchedulerSuite):
    component = "lookahead"
