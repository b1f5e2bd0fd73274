"""What all figures are drawn with: the page they stand on, and curves made ready for it."""
