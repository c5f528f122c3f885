# SPDX-License-Identifier: Apache-2.0

"""Views of simulations in a browser."""

from __future__ import annotations

import sys
import warnings
import weakref
import webbrowser

from cohort import _files


def _is_in_jupyter():
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return hasattr(shell, "kernel")


class View:
    """A web server in this process that shows a simulation in a browser; returned by `Simulation.view`.

    It ends with `close`, at the end of a `with` block, or when neither the view nor the simulation is referenced.
    """

    def __init__(self, simulation, name: str, port: int | None) -> None:
        if port is not None and not 0 <= port <= 65535:
            raise ValueError(f"port is {port}, expected 0 to 65535")
        self._simulation = simulation  # keeps the simulation alive
        self._native = simulation.open_view(str(_files.page_folder()), port)
        self._name = name
        self.port: int = self._native.port
        self.url: str = f"http://127.0.0.1:{self.port}/"
        weakref.finalize(self, self._native.close)  # also when Python exits

    @property
    def closed(self) -> bool:
        """True if the view has ended."""
        return self._native.is_closed

    def close(self) -> None:
        """Ends the view and frees its port. Open pages keep their last image."""
        self._native.close()

    def open(self) -> None:
        """Opens the page in a browser; does nothing in Jupyter, which displays the view itself."""
        if not _is_in_jupyter() and not webbrowser.open(self.url):
            warnings.warn(f"no browser was found; open {self.url} yourself", stacklevel=3)

    def __enter__(self) -> View:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _repr_html_(self) -> str:
        if self.closed:
            return "<p>This view of a simulation is closed.</p>"
        return f'<iframe src="{self.url}" width="100%" height="500" style="border: 0" allowfullscreen></iframe>'

    def __repr__(self) -> str:
        return f"<cohort.View of {self._name}: {'closed' if self.closed else self.url}>"
