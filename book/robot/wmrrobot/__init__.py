"""A robot of one's own: its settings, the checks of its sensors, and the C that runs on it.

`import wmrrobot as wr`; a name is loaded when it is first used. The modules `printing` (formulas to
C), `monitor`, `odometry`, `kalman` and `sensing` (the parts of drive and filter) are public too.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
