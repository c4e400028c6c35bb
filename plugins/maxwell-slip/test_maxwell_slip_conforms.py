"""Law passes what any law must: the whole battery, some minutes."""

from maxwell_slip import MaxwellSlip
from profiles import deep

from frictionlab.testing import check_law


@deep("the whole battery takes minutes")
def test_the_law_conforms():
    check_law(MaxwellSlip)
