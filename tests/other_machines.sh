#!/usr/bin/env bash
# Runs the tests of numbers as two other processors round: one without fused multiply-add, one with nothing but the
# instructions that all of its kind have. Each has kernels of its own. Exit code 1 where one of them fails.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

python=.venv/bin/python
numbers=(tests/{analysis,bench,compile,curves,golden,laws,methods,motion,runner,study,theory,values}
  tests/test_{docstrings,studies,ten_jobs,pages}.py plugins)
above_the_least=$($python -c '
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__
print(*(name for name in __cpu_dispatch__ if __cpu_features__[name]))')

code=0
rounding() { # rounding NAME SETTING...
  echo "Rounding as a processor of the kind $1"
  env FRICTIONLAB_CACHE="$PWD/build/kernels/$1" "${@:2}" $python -m pytest "${numbers[@]}" || code=1
}
rounding generic NUMBA_CPU_NAME=generic NPY_DISABLE_CPU_FEATURES="$above_the_least"
[ "$(uname -m)" != x86_64 ] || rounding haswell NUMBA_CPU_NAME=haswell NUMBA_CPU_FEATURES=-fma
exit $code
