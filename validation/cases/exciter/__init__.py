"""Dual-frequency exciter against its source [YF17]."""
