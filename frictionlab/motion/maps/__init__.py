"""Period maps: Coulomb and Stribeck sliding, exact bristle paths, laws with memory."""
