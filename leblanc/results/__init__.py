"""What the studies found, and how it is written for other programs: netCDF and JSON."""
