"""The figures of results, as PNG and SVG, and films.

Figures are drawn on the object interface: to import pyplot costs more than to draw them all. `page` is the
only door to matplotlib; a figure carries its caption, its alternative text and its size.
"""

from leblanc.figures.chambers import chamber_figure as chamber_figure
from leblanc.figures.page import FigureFiles as FigureFiles
from leblanc.figures.page import save as save
from leblanc.figures.page import style as style
from leblanc.figures.response import amplitude_figure as amplitude_figure
from leblanc.figures.response import campbell_figure as campbell_figure
from leblanc.figures.response import liquid_figure as liquid_figure
from leblanc.figures.response import phase_figure as phase_figure
from leblanc.figures.response import write_figures as write_figures
from leblanc.figures.wave import animate as animate
from leblanc.figures.wave import history_figure as history_figure
from leblanc.figures.wave import wave_figure as wave_figure
