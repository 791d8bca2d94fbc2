"""The linguistic report as one page that stands alone: style and drawing are inside."""

from collections.abc import Iterable, Sequence
from html import escape
from importlib.resources import files
from string import Template

from kb.lexicon.links import ThesisClaim
from kb.reports.drawing import draw
from kb.reports.linguistics import ClassReport, How, LinguisticReport, VerbReport, named
from kb.reports.plain import TITLE
from kb.reports.tables import coverage, shown_by, tables

LEAD = (
    "English verbs of motion by the classes of Beth Levin’s book: what the thesis said could be "
    "addressed, and what the rule base addresses now. Each status is derived by rules over the "
    "primitives, the lexicon and the observations; none is typed in."
)
SECTIONS = (
    ("drawing", "Drawing"),
    ("classes", "Classes"),
    ("senses", "Senses"),
    ("claims", "Claims"),
    ("remarks", "Remarks"),
)


def as_html(report: LinguisticReport) -> str:
    """The page; it loads nothing."""
    folder = files("kb") / "reports"
    parts = (
        _head(report),
        _section("drawing", f"<figure>{draw(report)}</figure>"),
        _section("classes", *map(_class, report.classes)),
        _section("senses", _table(report, "Senses", code=4)),
        _section("claims", _table(report, "Claims of the thesis")),
        _section(
            "remarks",
            *(f'<p class="remark">{_remark(*each)}</p>' for each in _remarks(report)),
            *(f'<p class="remark">{escape(each)}.</p>' for each in report.doubts),
        ),
        '<footer class="page">Senses and glosses: WordNet 3.1, © 2011 Princeton University; '
        "indices: CILI. Classes: B. Levin, <i>English Verb Classes and Alternations</i>, 1993."
        "</footer>",
    )
    template = Template((folder / "page.html").read_text(encoding="utf-8"))
    style = (folder / "page.css").read_text(encoding="utf-8")
    return template.substitute(title=escape(TITLE), style=style, body="\n".join(parts))


def _head(report: LinguisticReport) -> str:
    links = "".join(f'<a href="#{key}">{words}</a>' for key, words in SECTIONS)
    figures = "".join(
        f"<div><dt>{escape(what)}</dt><dd>{escape(much)}</dd></div>"
        for what, much in coverage(report)
    )
    return (
        f'<h1>{escape(TITLE)}</h1>\n<p class="lead">{LEAD}</p>\n<nav>{links}</nav>\n'
        f'<dl class="figures">{figures}</dl>'
    )


def _section(key: str, *parts: str) -> str:
    title = dict(SECTIONS)[key]
    return f'<section id="{key}">\n<h2>{title}</h2>\n' + "\n".join(parts) + "\n</section>"


def _tag(style: str, words: str) -> str:
    return f'<span class="tag {style}">{escape(words)}</span>'


def _class(each: ClassReport) -> str:
    thesis = " ".join(_tag(status.value, status.value) for status in each.thesis)
    head = (
        f'<header><span class="number">{each.number}</span><h3>{escape(each.title)}</h3>'
        f'<span><span class="who">thesis</span>{thesis}</span>'
        f'<span><span class="who">now</span>{_tag(each.status.value, each.status.words)}</span>'
        "</header>"
    )
    rules = ", ".join(f"<code>{escape(file)}</code>" for file in each.files) or "none"
    body = [
        f"<p>{escape(each.reason)}</p>",
        _verbs([verb for verb in each.verbs if verb.counts]),
        _others([verb for verb in each.verbs if not verb.counts]),
        _small(f"Primitives: {escape(named(each.primitives))}. Rules: {rules}."),
        _evidence(each),
        *map(_quote, each.claims),
        *(f'<p class="remark">{escape(remark.text)}</p>' for remark in each.remarks),
    ]
    inner = "\n".join(part for part in body if part)
    return f'<article id="class-{each.number}">{head}\n<div class="body">{inner}</div></article>'


def _small(text: str) -> str:
    return f'<p class="small">{text}</p>'


def _evidence(each: ClassReport) -> str:
    if not each.proofs:
        return ""
    return _small(f"Shown by {escape(shown_by(each))}; {each.segments} segments in all.")


def _verbs(verbs: Sequence[VerbReport]) -> str:
    rows = "".join(_verb(each) for each in verbs)
    return f'<div class="scroll"><table><tbody>{rows}</tbody></table></div>' if rows else ""


def _verb(each: VerbReport) -> str:
    glosses = "<br>".join(
        f"{escape(sense.definition)} <code>{sense.ili or sense.offset}</code>"
        for sense in each.senses
    )
    cells = (_tag(each.how.value, each.standing), escape(", ".join(each.primitives)), glosses)
    rest = "".join(f"<td>{cell}</td>" for cell in cells)
    return f'<tr><td class="verb">{escape(each.verb)}</td>{rest}</tr>'


def _others(verbs: Sequence[VerbReport]) -> str:
    """Members that VerbNet lists beside the verbs by which the class is judged."""
    if not verbs:
        return ""
    marked = ", ".join(
        f"<b>{escape(each.verb)}</b>" if each.how is How.ADDRESSED else escape(each.verb)
        for each in verbs
    )
    return (
        f'<details class="more"><summary>{len(verbs)} more members in VerbNet</summary>'
        f'<p class="small">{marked}</p></details>'
    )


def _quote(claim: ThesisClaim) -> str:
    verbs = ", ".join(claim.verbs)
    return (
        f"<blockquote><p>“{escape(claim.quote)}”</p><footer>Thesis {escape(claim.section)}, "
        f"{escape(verbs)}: {_tag(claim.status.value, claim.status.value)} {escape(claim.reason)}"
        "</footer></blockquote>"
    )


def _table(report: LinguisticReport, wanted: str, *, code: int = -1) -> str:
    _, heads, rows = next(each for each in tables(report) if each[0] == wanted)
    head = "".join(f"<th>{escape(each)}</th>" for each in heads)
    body = "".join(f"<tr>{''.join(_cells(row, code))}</tr>" for row in rows)
    return (
        f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
        "</div>"
    )


def _cells(row: Sequence[str], code: int) -> Iterable[str]:
    for index, cell in enumerate(row):
        text = f"<code>{escape(cell)}</code>" if index == code else escape(cell)
        yield f'<td class="name">{text}</td>' if index == 0 else f"<td>{text}</td>"


def _remarks(report: LinguisticReport) -> Iterable[tuple[str, str, str]]:
    return ((each.levin, each.verb, each.text) for each in report.remarks)


def _remark(levin: str, verb: str, text: str) -> str:
    return f"<b>{escape(verb)}</b> ({escape(levin)}). {escape(text)}"
