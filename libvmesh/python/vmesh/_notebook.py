"""How a surface looks as the result of a notebook's cell."""

from __future__ import annotations

import html
from typing import Optional

from . import _core
from ._errors import Unsupported

# A page holds about 40 bytes a face; what is shown stays in the notebook's file. This keeps it below 25 MB.
MOST_FACES = 500_000


def shown(surface: _core.Surface) -> Optional[str]:
    """The page in a frame of its own, apart from the notebook's styles and scripts; None: the text is shown instead."""
    if len(surface.faces) == 0 or len(surface.faces) > MOST_FACES:
        return None
    try:
        page = _core.page_text(surface, title="surface")
    except Unsupported:
        return None
    return f'<iframe srcdoc="{html.escape(page)}" style="width: 100%; height: 600px; border: 0"></iframe>'
