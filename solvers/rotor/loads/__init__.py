"""Forces and clearances of a machine from the motion of its rotor.

`machine` puts them together; `frame` has the directions, `floor` the feet of a cabinet, `bearings` the
forces between drum and tub, `turn` what one turn of a steady motion holds.
"""
