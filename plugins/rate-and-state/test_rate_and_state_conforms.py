"""Law passes what any law must: the whole battery, some minutes."""

from profiles import deep
from rate_and_state import RateAndState

from frictionlab.testing import check_law


@deep("the whole battery takes minutes")
def test_the_law_conforms():
    check_law(RateAndState)
