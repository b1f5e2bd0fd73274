"""Where the liquid is: chambers, sections, meshes. No liquid, no time."""
