"""Body, its springs, dashpots, loads and the belt it slides on."""
