"""What Python users hold: laws compared on a scene, with tables, arrays and pages."""
