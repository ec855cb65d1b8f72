"""Pages that show paths in 3D and need nothing but themselves: no server, no network, no other file.

    html = page(scene, record, cursor, Speaker("en"), rgb=picture.rgb)

`page` is one pixel of one scene. Who shows several places in a page of its own collects them in a `View`, and
gives the `document` the `furniture` (styles, scripts) and `View.script()` beside `<div class="castray-3d">`.
"""

from viewer.offline.page import BEGIN, document, figure, furniture, page
from viewer.offline.view import View

__all__ = ["BEGIN", "View", "document", "figure", "furniture", "page"]
