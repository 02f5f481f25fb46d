"""A run to look at: one web page that plays it, offline and without a server; or a movie.

    page > frames | solids | conserved | threejs > packing
    movie > facets > frames | solids | conserved

``page/`` holds what the browser gets: ``page.html`` and ``page.css``, and a script an idea. ``motion.js``: where bodies
are between rows, numbers only; ``space.js``: what is drawn; ``camera.js``: from where; ``panel.js``: what is said;
``player.js``: time, and who presses what. three.js, which draws, comes out of trimesh, which brings it along.
"""

from binaryast.viewer.movie import animate
from binaryast.viewer.page import view

__all__ = ["animate", "view"]
