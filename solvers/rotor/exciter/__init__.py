"""The dual-frequency exciter: balls stuck in a race on an unbalanced shaft shake a platform."""
