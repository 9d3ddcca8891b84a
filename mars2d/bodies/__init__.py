"""Bodies: drives that move them, props that robots push, joints that tie them together."""

from mars2d.bodies.drives import *  # noqa: F403
from mars2d.bodies.drives import __all__ as _drives
from mars2d.bodies.joints import *  # noqa: F403
from mars2d.bodies.joints import __all__ as _joints
from mars2d.bodies.props import *  # noqa: F403
from mars2d.bodies.props import __all__ as _props

__all__ = [*_drives, *_joints, *_props]  # noqa: PLE0604
