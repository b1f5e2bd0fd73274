"""Machines that bring an answer of their own; nothing imports them but the registry."""
