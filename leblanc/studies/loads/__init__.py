"""What a machine is judged by: forces under its feet, clearances, forces in its parts, its motor."""
