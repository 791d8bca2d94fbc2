"""The formats of the linguistic report, by name."""

from collections.abc import Callable, Mapping

from capar.model.errors import UnknownNameError
from kb.reports.drawing import draw
from kb.reports.linguistics import LinguisticReport
from kb.reports.page import as_html
from kb.reports.plain import as_csv, as_json, as_latex, as_markdown, as_text

FORMATS: Mapping[str, Callable[[LinguisticReport], str]] = {
    "text": as_text,
    "md": as_markdown,
    "html": as_html,
    "csv": as_csv,
    "json": as_json,
    "latex": as_latex,
    "svg": draw,
}


def write(report: LinguisticReport, form: str) -> str:
    """The report in a format.

    Raises:
        UnknownNameError: There is no such format.
    """
    if form not in FORMATS:
        raise UnknownNameError("format", form, FORMATS)
    return FORMATS[form](report)
