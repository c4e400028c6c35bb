"""Period (Poincare) map of every law, its fixed points, and their continuation in belt speed."""
