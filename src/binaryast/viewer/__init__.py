"""A run as one web page that plays it: works from a file, without a server and without a network.

    page > frames | solids | conserved | threejs

``page/`` holds what the browser gets: ``page.html`` and ``page.css``, and a script an idea. ``motion.js``: where bodies
are between rows, numbers only; ``space.js``: what is drawn; ``camera.js``: from where; ``panel.js``: what is said;
``player.js``: time, and who presses what. three.js, which draws, comes out of trimesh, which brings it along.
"""

from binaryast.viewer.page import view

__all__ = ["view"]
