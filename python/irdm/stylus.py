"""This program as a stylus of a running server."""

import atexit
import weakref

from irdm import _core
from irdm.scene import to_toml

_open = weakref.WeakSet()


class Stylus(_core.StylusCore):
    """A stylus of a running irdm-server, made by connect(); also a context manager.

    In real time a thread below Python runs 1000 ticks a second, with a bridge's link rules, contact prediction and safety
    filter (docs/safety.md): set() gives it the newest tip, `force` is what it shows. A lost server is looked for again.
    In lockstep step() is one step of the server, and its force is the server's own, unfiltered.
    """

    @classmethod
    def connect(cls, address, tip=None, *, stylus=None, lockstep=False, timeout=5.0, device=None):
        """Connects to "host:port". Raises irdm.Error when no session begins within timeout [s].

        tip: (3) where the stylus is until the first set() [m]; required, but not in lockstep. stylus: number in the scene;
        None: the first that is free. lockstep: the server runs with --lockstep. device: dict with keys of a bridge's
        table [bridge] (docs/configuration.md; not server, link, black_box), `workspace` as of a [[device]] (not in
        lockstep), and stale_after (0.05): a tip counts for so long [s], then the stylus stays, is not ready, and has no
        force.
        """
        options = dict(device or {}, lockstep=lockstep, timeout=timeout)
        if tip is not None:
            options["tip"] = [float(x) for x in tip]
        if stylus is not None:
            options["stylus"] = stylus
        return cls(address, to_toml(options))

    def __init__(self, address, options):
        super().__init__(address, options)
        _open.add(self)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


@atexit.register
def _close_all():
    for stylus in list(_open):
        stylus.close()
