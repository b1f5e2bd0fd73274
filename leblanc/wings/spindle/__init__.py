"""A spindle unit: compliances between two of its stations, over frequency and at its natural frequencies."""
