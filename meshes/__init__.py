"""Where the liquid is: chambers, sections, meshes. No liquid, no time.

`chamber` and `section` are what a machine has, `liquid_section` the liquid at rest in it; `rings`, `refine`
and `bodies` make meshes, `files` reads and writes them, `quality` and `findings` judge them.
"""
