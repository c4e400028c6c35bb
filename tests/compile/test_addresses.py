"""What lies at an address: numbers and arrays that outlive every kernel that calls there."""

from __future__ import annotations

import numpy as np
from memory_laws import elements

from frictionlab.compile.law_addresses import by_address


def test_arrays_of_a_law_at_an_address_have_no_owner_to_count_users_with() -> None:
    """That owner is gone once the call that wrote them there has ended: counting with it wrote into freed memory."""
    law = elements((1.0, 2.0), (0.1, 0.2))
    room, entry = by_address(law, planar=False).held
    owner_parent_size_itemsize_data = np.frombuffer(room, np.uint64)[:5]
    first = next(each for each in entry.bound[0] if isinstance(each, np.ndarray))

    assert owner_parent_size_itemsize_data.tolist() == [0, 0, 2, 8, first.ctypes.data]
