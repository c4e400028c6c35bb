"""Contacts that age: every number is what it was."""

from comparison import comparing

test_every_number_is_what_it_was = comparing("ages, line")
