"""What acts on a mass at the half steps of a lap of equal steps, for steppers that meet it there alone.

It is one array [2 steps + 1, 3], complex in the plane: kernels count the references to every array they hand on.
"""

LOAD, NORMAL_LOAD, BELT = 0, 1, 2
"""Its columns; BELT: velocity of the belt."""
