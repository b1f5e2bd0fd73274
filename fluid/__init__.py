"""What the liquid does: equations and closed forms as pure array functions."""
