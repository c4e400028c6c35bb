"""Laws without memory, along a line: every number is what it was."""

from comparison import comparing

test_every_number_is_what_it_was = comparing("nothing, line")
