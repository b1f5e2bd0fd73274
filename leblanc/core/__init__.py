"""What every question and answer has: declared quantities, their JSON and data, blocks and their renderers."""
