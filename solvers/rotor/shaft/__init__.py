"""Shafts of sections with distributed mass: vibration at one frequency, without any mesh.

`section` has the exact matrices of a uniform section, `structure` joins sections to a machine and gives its
dynamic compliances, `natural` its natural frequencies and mode shapes; `substructures` goes the way of the
source, by the compliances of free parts and the reactions between them.
"""
