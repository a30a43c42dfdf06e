# The public names and where they live, for lazy_loader, editors and type checkers.
from . import commissioning as commissioning
from . import estimation as estimation
from .drive import Drive as Drive
from .exports import along as along
from .exports import at_rest as at_rest
from .exports import files as files
from .monitor import Rules as Rules
from .monitor import Seen as Seen
from .sheets import RECEIVERS as RECEIVERS
from .sheets import Certificate as Certificate
from .sheets import Robot as Robot
from .sheets import Sheet as Sheet
from .sheets import certificate as certificate
from .sheets import sheet as sheet
