"""The library that draws interactive charts, as text that a page holds.

It is Vega-Lite, in the bundle that vl-convert carries: a chart is data instead of code, its expressions are interpreted
so that a page needs no `eval`, marks are SVG with labels that screen readers read, and packed it takes 0.4 MB. Plotly's
smallest bundle takes 0.5 MB.
"""

from __future__ import annotations

import base64
import gzip
from importlib.metadata import version

# The package that carries it, and what is kept of it under this name.
PACKAGE = "vl-convert-python"


def name() -> str:
    """The library and its version."""
    return f"{PACKAGE} {version(PACKAGE)}"


def script() -> str:
    """The library as a script that defines `vegaEmbed`. Takes seconds."""
    import vl_convert

    return f"(() => {{{vl_convert.javascript_bundle('window.vegaEmbed=vegaEmbed')}}})();"


def packed(text: str) -> str:
    """Text as base64 of gzip, the same each time."""
    return base64.b64encode(gzip.compress(text.encode(), mtime=0)).decode("ascii")
