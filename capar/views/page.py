"""An observation as a piece of HTML, whole in itself: its table and its picture."""

from base64 import b64encode
from html import escape

from capar.model.observation import Observation
from capar.views.notices import note_lines
from capar.views.picture import svg
from capar.views.tables import joint_lines, segment_rows

CELL = "text-align:left;padding:2px 8px;white-space:nowrap"


def observation_page(observation: Observation) -> str:
    """A table of segments, the picture, and what is known with reservations, as notebooks show it.

    The picture is embedded as an SVG image: it can neither run anything nor clash with others on
    the page.
    """
    title = f"{observation.capture}, {observation.duration_s:.2f} s, {observation.profile} rules"
    joint = "".join(f"<div>{escape(each)}</div>" for each in joint_lines(observation))
    notes = "".join(f"<li>{escape(each)}</li>" for each in note_lines(observation.notices))
    picture = b64encode(svg(observation).encode()).decode("ascii")
    return (
        f'<div class="capar-observation"><p><b>{escape(title)}</b></p>{_table(observation)}{joint}'
        f'<img alt="{escape(title)}" style="max-width:100%" '
        f'src="data:image/svg+xml;base64,{picture}"/>'
        + (f"<details><summary>Notices</summary><ul>{notes}</ul></details>" if notes else "")
        + "</div>"
    )


def _table(observation: Observation) -> str:
    head, *rows = segment_rows(observation)
    return (
        f"<table><thead>{_row(head, 'th')}</thead>"
        f"<tbody>{''.join(_row(each, 'td') for each in rows)}</tbody></table>"
    )


def _row(cells: tuple[str, ...], tag: str) -> str:
    inner = "".join(f'<{tag} style="{CELL}">{escape(each)}</{tag}>' for each in cells)
    return f"<tr>{inner}</tr>"
