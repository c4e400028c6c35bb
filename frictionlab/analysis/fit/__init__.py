"""Laws from measurements: least squares over curves and paths of slip, with errors that hold for correlated data."""
