"""What the site says of parameters and types that a docstring leaves to their names."""

COMMON = {
    "scene": "what moves, and what shakes it",
    "law": "of friction",
    "laws": "one, a list, or a mapping label -> law",
    "study": "a file, what one says, or a ``Study``",
    "out": "the folder for results",
    "method": "a name, or a method such as ``fl.March(steps=1000)``",
    "methods": "a name, a method, a list of them, or a mapping label -> method",
    "tolerance": "absolute, on ``mean_friction``",
    "columns": "result columns and groups of them",
    "executor": "any of ``concurrent.futures``; threads of this process where left out",
    "over": "lists or ranges by path",
    "starts": "so many at each belt speed",
    "periods": "so many",
    "cache_gigabytes": "the most that the cache may hold",
    "drive": "the load along the belt",
    "transverse": "the motion across the belt",
    "load": "across the belt",
    "body": "its spring and dashpot where they are not linear",
    "slip": "prescribed, along the belt",
    "transverse_slip": "prescribed, across the belt",
    "belt_vibration": "of the belt",
    "normal_load_variation": "in time",
    "initial": "where the motion starts",
    "dimensional": "the scene in SI units, in place of all else",
    "displacement_amplitude_m": "in place of the velocity amplitude",
    "acceleration_amplitude_m_per_s2": "in place of the velocity amplitude",
    "mu": "friction coefficient in steady sliding",
    "mu_kinetic": "friction coefficient in quick sliding, without viscosity",
    "mu_static": "friction coefficient at rest",
}
"""Of parameters that many have, where a docstring does not say more."""

SHORT = {
    "progress": "tells on stderr how far it is; None: in a terminal or notebook",
}
"""In place of what docstrings say again and again."""

TYPES = {
    r"\bArrayLike\b": "number | list | array",
    r"\bLawsGiven\b": "law | list | dict",
    r"\bMethodsGiven\b": "str | method | list | dict",
    r"\bProgressAsked\b": "bool | None",
    r"\bExisting\b": "'reuse', 'replace'",
    r"\bPathLike\[str\]": "path",
    r"\bMapping\[[^\]]*\]": "dict",
    r"\bSequence\[str\]": "list of str",
    r"\bMethod\b": "method",
    r"\bExecutor\b": "executor",
    r" \| Workforce\b": "",
}
"""Types as a reader of the site calls them."""
