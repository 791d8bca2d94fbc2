"""Elements of SVG drawings, their text escaped."""

from html import escape


def text(x: object, y: object, content: str, **attributes: object) -> str:
    """A line of text that begins at a point; ``class_`` and ``font_size`` name attributes."""
    return f'<text x="{x}" y="{y}"{_stated(attributes)}>{escape(content)}</text>'


def rect(
    x: object, y: object, width: object, height: object, *, radius: int, **attributes: object
) -> str:
    """A rectangle with round corners, from its upper left one."""
    place = f'x="{x}" y="{y}" width="{width}" height="{height}" rx="{radius}"'
    return f"<rect {place}{_stated(attributes)}/>"


def _stated(attributes: dict[str, object]) -> str:
    return "".join(
        f' {name.rstrip("_").replace("_", "-")}="{escape(str(value))}"'
        for name, value in attributes.items()
    )
