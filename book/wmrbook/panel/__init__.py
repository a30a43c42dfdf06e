"""What is live in a page: the Explorer, and the kit that it and the live figures are made of."""

from wmrbook.panel.explorer import Explorer  # noqa: F401
from wmrbook.panel.front import Front  # noqa: F401
from wmrbook.panel.my_robot import MyRobot  # noqa: F401
