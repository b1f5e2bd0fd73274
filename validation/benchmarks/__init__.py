"""Cost against accuracy of every wave model, beside other codes in the same run; see docs/accuracy.md."""
