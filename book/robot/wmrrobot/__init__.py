"""A robot of one's own: what it is told, what it trusts, and the C that runs on it.

`import wmrrobot as wr`; a name is loaded when it is first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
