"""Shafts of sections with distributed mass: vibration at one frequency, without any mesh.

`section` has exact matrices of a uniform section, `structure` joins sections and gives dynamic compliances,
`natural` natural frequencies and shapes; `substructures` goes the way of the source.
"""
