from .fields import Diverging as Diverging
from .fields import Jet as Jet
from .fields import Rotation as Rotation
from .reproduce import Reproduction as Reproduction
from .reproduce import reproduce as reproduce
from .sampled import SampledTest as SampledTest
from .tables import Table as Table
