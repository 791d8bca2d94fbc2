"""Know: what the Actionary says of actions, agents and objects, and what it answers."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from capar.model.errors import CaparError
from capar.model.observation import SegmentAddress
from capar.pipelines.linguistic_report import linguistics, primitive_files
from capar.views import html
from capar.workbench.window import Panel
from kb import Actionary
from kb.corrections import Correction, account
from kb.corrections import correct as claim
from kb.queries.questions import cells, check_known, header, notes, questions
from kb.reports.complex_actions import as_text
from kb.reports.formats import write
from kb.store import sparql
from kb.store.answer_values import Answer
from kb.store.stores import DATA_FOLDER

NONE = "(none)"
EXAMPLE = "SELECT ?name WHERE {\n  ?action a capar:Upar ;\n    rdfs:label ?name\n}"
TIME_LIMIT_S = 30.0
FIELDS = 6
"""A question has at most so many fields beside each other; others are written as NAME=VALUE."""

ADDRESS, CAPTURES = ("address",), ("observation", "capture")
TIMES = ("time", "begins", "looked", "first")
"""Columns of answers that lead to a segment, to a capture, and to a moment [s]."""


class Know(Panel):
    """Knowledge."""

    title = "Know"

    def build(self) -> None:
        """Add the controls."""
        gui, guard = self.gui, self.window.guard
        self._answer: tuple[Answer, list[tuple[str, float, str]]] | None = None
        self._where = gui.add_html("")
        self._kept = gui.add_html("")
        self.button("Keep what was observed", self.keep, self._kept)
        with gui.add_folder("Ask"):
            known = questions()
            self._question = gui.add_dropdown("question", list(known), initial_value="segments")
            self._question.on_update(guard(None, self._fields_of_question))
            self._text = gui.add_html("")
            self._values = [gui.add_text("", "", visible=False) for _ in range(FIELDS)]
            self._more = gui.add_text("more", "", hint="Other filters: NAME=VALUE, NAME=VALUE")
            self._ask_said = self.button("Ask", self._ask)
        with gui.add_folder("SPARQL", expand_by_default=False):
            self._sparql = gui.add_text("query", EXAMPLE, multiline=True)
            self._sparql_said = self.button("Run", lambda: self.query(self._sparql.value))
        with gui.add_folder("Answer"):
            self._lead = gui.add_dropdown("go to", [NONE], hint="The moment that a row is about.")
            self._lead.on_update(guard(None, self._go))
            self._table = gui.add_html(html.note("Nothing was asked yet."))
        with gui.add_folder("Everything about", expand_by_default=False):
            self._kind = gui.add_dropdown("of", ("action", "agent", "object"))
            self._name = gui.add_dropdown("name", [NONE])
            self._kind.on_update(guard(None, self._names))
            self._name.on_update(guard(None, self._about))
            self._profile = gui.add_html("")
        with gui.add_folder("Correct a segment", expand_by_default=False):
            self._build_corrections()
        with gui.add_folder("Linguistic report", expand_by_default=False):
            self._report_said = self.button("Make it", self.report)
            self._report = gui.add_html("")
        self._fields_of_question()

    def _build_corrections(self) -> None:
        gui = self.gui
        self._claim_of = gui.add_text("segment", "", hint="END_EFFECTOR/INDEX; the chosen one.")
        self._claim = gui.add_dropdown("change", ("name", "start", "end", "split", "join"))
        self._claim_value = gui.add_text("value", "", hint="A name, or a time in seconds.")
        self._by = gui.add_text("by", "", hint="Who says so.")
        self._claim_said = self.button("Keep this claim", self.correct)
        self._claims = gui.add_html("")

    def captured(self) -> None:
        """Say what is asked: an Actionary, or what is open."""
        place = self.window.settings.actionary
        text = f"What {place} holds is asked." if place else (
            "What is open in this window is asked. Open it with an Actionary to keep it."
        )  # fmt: skip
        self._where.content = html.note(text)
        self._names()

    def chosen(self) -> None:
        """Offer the chosen segment to be corrected."""
        segment = self.window.segment
        if segment is not None:
            self._claim_of.value = f"{segment.ee}/{segment.index}"

    @contextmanager
    def book(self, *, write: bool = False) -> Iterator[Actionary]:
        """The Actionary; without one, what is open in the window, in memory."""
        place = self.window.settings.actionary
        if place is not None and (write or (Path(place) / DATA_FOLDER).is_dir()):
            with Actionary.open(place, read_only=not write, wait_s=5.0) as book:
                yield book
            return
        if write:
            raise CaparError(
                "no Actionary is open; end this window, and open it with the folder of one: "
                "capar open CAPTURE ACTIONARY"
            )
        with Actionary.in_memory() as book:
            for each in self.window.captures:
                if each.observation is not None:
                    book.add(each.observation, replace=True)
            yield book

    def keep(self) -> str:
        """Add the observation of the capture that is looked at to the Actionary."""
        _, seen = self.window.need()
        with self.book(write=True) as book:
            known = book.recognise(seen.observation.complex_par)
            added = book.add(seen.observation, name=known or None)
        self._names()
        return (
            f"kept {added.name}: {added.action}" + ", in place of the earlier one" * added.replaced
        )

    # Questions

    def _fields_of_question(self) -> None:
        asked = questions()[self._question.value]
        self._text.content = html.text(asked.text)
        shown = asked.parameters[:FIELDS]
        for number, field in enumerate(self._values):
            field.visible = number < len(shown)
            field.value = ""
            if field.visible:
                each = asked.parameters[number]
                field.label = f"{each.name} *" if each.required else each.name
                field.hint = each.meaning
        rest = [each.name for each in asked.parameters[len(shown) :]]
        self._more.visible, self._more.value = bool(rest), ""
        self._more.hint = f"NAME=VALUE, NAME=VALUE of: {', '.join(rest)}"

    def _ask(self) -> str:
        asked = questions()[self._question.value]
        given = {
            each.name: field.value.strip()
            for each, field in zip(asked.parameters[:FIELDS], self._values, strict=False)
            if field.value.strip()
        }
        for part in filter(None, map(str.strip, self._more.value.split(","))):
            name, sign, value = part.partition("=")
            if not sign:
                raise CaparError(f"{part!r} is no filter; one is written NAME=VALUE")
            given[name.strip()] = value.strip()
        return self.ask(self._question.value, given)

    def ask(self, name: str, given: dict[str, str]) -> str:
        """Ask a named question and show what is answered."""
        asked = questions()[name]
        self._table.content = ""
        with self.book() as book:
            found = book.store.ask_within(asked.bind(given), seconds=TIME_LIMIT_S)
            if not found.rows:
                check_known(book.store, asked, given)
        self._show(found)
        return "\n".join(notes(asked, found)) if found.rows else "nothing found"

    def query(self, text: str) -> str:
        """Ask SPARQL and show what is answered; it can only read."""
        self._table.content = ""
        with self.book() as book:
            found = book.query(text, seconds=TIME_LIMIT_S)
        self._show(found)
        unknown = "\n".join(sparql.unknown_terms(text))
        return unknown or ("" if found.rows or found.boolean is not None else "nothing found")

    def _show(self, found: Answer) -> None:
        self._answer = found, _leads(found)
        names = list(header(found))
        self._table.content = html.table(cells(found), names)
        rows = [f"{n}. {' '.join(row)[:60]}" for n, row in enumerate(cells(found), 1)]
        self._lead.options = [NONE, *(rows if any(lead[0] for lead in self._answer[1]) else ())]
        self._lead.value = NONE

    def _go(self) -> None:
        if self._answer is not None and self._lead.value != NONE:
            self.go_to(int(self._lead.value.partition(".")[0]) - 1)

    def go_to(self, row: int) -> None:
        """Lead to the moment that a row of the answer is about."""
        if self._answer is None or row >= len(self._answer[1]):
            raise CaparError("there is no such row")
        capture, time_s, segment = self._answer[1][row]
        self.window.go_to(capture, time_s, segment)

    # Everything about

    def _names(self) -> None:
        with self.book() as book:
            known: dict[str, Callable[[], Sequence[str]]] = {
                "action": lambda: sorted({each.action for each in book.observations()}),
                "agent": book.agents,
                "object": book.object_kinds,
            }
            names = list(known[self._kind.value]())
        self._name.options = [NONE, *names]
        self._name.value, self._profile.content = NONE, ""

    def _about(self) -> None:
        if self._name.value != NONE:
            self._profile.content = self.about(self._kind.value, self._name.value)

    def about(self, kind: str, name: str) -> str:
        """Every field of an action, agent or kind of object, as HTML."""
        with self.book() as book:
            if kind == "action":
                return html.code(as_text(book, name))
            fields = book.agent_profile(name) if kind == "agent" else book.object_profile(name)
        rows = [(field, ", ".join(values) or "(nothing)") for field, values in fields.items()]
        return html.table(rows, ("field", "values"))

    # Corrections

    def correct(self) -> str:
        """Keep a person's claim about a segment; what the machine says stays."""
        opened, _ = self.window.need()
        what, value = self._claim.value, self._claim_value.value.strip()
        by = self._by.value.strip()
        if not by:
            raise CaparError("say who says so, in the field by")
        try:
            change = {
                "name": lambda: Correction(name=value),
                "start": lambda: Correction(start_s=float(value)),
                "end": lambda: Correction(end_s=float(value)),
                "split": lambda: Correction(split_s=float(value)),
                "join": lambda: Correction(join=True),
            }[what]()
        except ValueError:
            raise CaparError(f"{value!r} is no time in seconds") from None
        name = opened.trial.name
        address = replace(SegmentAddress.parse(self._claim_of.value), capture=name)
        with self.book(write=True) as book:
            claim(book.store, address, change, by=by)
            spans = account(book.store, name)
        rows = [(s.ee, f"{s.start_s:.2f}", f"{s.end_s:.2f}", s.name, s.by) for s in spans]
        self._claims.content = html.table(rows, ("who", "from", "to", "what", "says"))
        return "kept; `capar query --corrected` uses it"

    # Report

    def report(self) -> str:
        """Make the linguistic report over rules and knowledge, in the background."""
        window = self.window

        def work(report: Callable[[str, float], None]) -> str:
            report("joining rules, verbs and what was observed", 0.3)
            files = primitive_files(window.settings.rule_base().added)
            with self.book() as book:
                return write(linguistics(files, store=book.store), "text")

        def done(text: Any) -> None:
            self._report.content = html.code(str(text))

        window.work("the linguistic report", self._report_said, work, done)
        return ""


def _leads(found: Answer) -> list[tuple[str, float, str]]:
    """The capture, time and segment that each row is about; empty and NaN where it says none."""
    out = []
    for row in found.plain():
        capture, time_s, segment = "", float("nan"), ""
        address = str(row.get("address") or "")
        if address.count("/") >= 2:
            capture, _, _ = address.rsplit("/", 2)
            segment = address[len(capture) + 1 :]
        else:
            capture = next((str(row[c]) for c in CAPTURES if row.get(c)), "")
            if row.get("ee") and row.get("index") is not None:
                segment = f"{row['ee']}/{row['index']}"
        time = next((row[c] for c in TIMES if isinstance(row.get(c), int | float)), None)
        time_s = time_s if time is None else float(time)
        out.append((capture, time_s, segment))
    return out
