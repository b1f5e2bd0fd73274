"""The spin programme of a scene: `steps`, the little language of its lines, and `table`, its keys."""
