"""Independent answers and cases that several tests share."""
