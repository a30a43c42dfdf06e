"""A figure together with the text that says what it shows."""

from __future__ import annotations

import base64
import html
import io

from matplotlib.figure import Figure


class Picture:
    """A matplotlib figure and the text that says what it shows, for readers who don't see it and for tests that compare text.

    figure: the Figure, to change or save; alt: the alternative text. Jupyter shows it as a PNG image with that text.
    """

    def __init__(self, figure: Figure, alt: str) -> None:
        self.figure = figure
        self.alt = alt

    def __repr__(self) -> str:
        return f"<Picture: {self.alt}>"

    def png(self, dots_per_inch: float = 108.0) -> bytes:
        """The picture as a PNG file."""
        buffer = io.BytesIO()
        self.figure.savefig(buffer, format="png", dpi=dots_per_inch, metadata={"Description": self.alt})
        return buffer.getvalue()

    def _repr_mimebundle_(self, include=None, exclude=None):
        """As HTML first, because JupyterLab gives a bare image/png no alternative text; as PNG for a printed book."""
        png, width = self.png(), round(self.figure.get_figwidth() * 72)
        image = f'<img alt="{html.escape(self.alt)}" width="{width}" src="data:image/png;base64,{base64.b64encode(png).decode()}">'
        return {"text/html": image, "image/png": png, "text/plain": repr(self)}, {"image/png": {"alt": self.alt, "width": width}}
