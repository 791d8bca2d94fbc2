"""Rules and the unknown: a drafted rule, what it would change, and the way back."""

import re
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import viser

from capar.model.errors import CaparError, FileError, RuleError, UnknownNameError
from capar.model.observation import SegmentAddress
from capar.rulebook.changes import (
    Renamed,
    Trial,
    add_reclassifying,
    remove_reclassifying,
    renamed,
    stored,
)
from capar.rulebook.drafts import rule_from_segment
from capar.views import html
from capar.views.tables import features, unknown_note
from capar.workbench.window import OpenCapture, Panel
from capar_rules.authoring.glossary import glossary
from capar_rules.authoring.user_primitives import add_rule, introduced, removable, rule_of, rules_of
from capar_rules.authoring.user_rules import user_rules
from capar_rules.borders.deflicker import steady
from capar_rules.lint.checking import admitted_profile, check, require
from capar_rules.lint.findings import errors
from capar_rules.lint.world_checks import audit
from extractors.readers.bundle.capture_toml import find_place, read_capture
from extractors.readers.drafting.toml_edit import with_table
from kb.store.stores import DATA_FOLDER

NONE = "(none)"
OVER = "(nothing)"
NOTHING_THERE = "% Draft a rule from a segment above, or write one here.\n"


class Rules(Panel):
    """Rules, and names for what is unknown."""

    title = "Rules"

    def build(self) -> None:
        """Add the controls."""
        gui, guard = self.gui, self.window.guard
        self._undo: list[tuple[str, Callable[[], None]]] = []
        with gui.add_folder("Name a segment"):
            self._unknown = gui.add_dropdown("unknown here", [NONE])
            self._unknown.on_update(guard(None, self._choose))
            self._about = gui.add_html(html.note("Choose a segment that no rule names."))
            self._name = gui.add_text("name", "", hint="Reads like MoveObjTo.")
            self._verb = gui.add_text("verb", "", hint="As in: she nudges the mug.")
            self._definition = gui.add_text("what it is", "")
            self._general = gui.add_dropdown("a kind of", [NONE])
            self._purpose = gui.add_text(
                "purpose", "", hint="What it is done for, in this capture."
            )
            self._draft_said = self.button("Draft a rule", self.draft, icon=viser.Icon.PENCIL)
        with gui.add_folder("Rule"):
            self.text = gui.add_text("text", NOTHING_THERE, multiline=True)
            self._over = gui.add_dropdown("precedes", [OVER, "all"])
            self._said = gui.add_html("")
            self.button("Check it", self.check, self._said, work="checking the rule")
            self.button("What would it change?", self.effect, self._said, work="trying the rule")
            self.button("Keep it", self.keep, self._said, color="green")
            self.button("Undo", self.undo, self._said, color="gray")
            self._changes = gui.add_html("")
        with gui.add_folder("All rules", expand_by_default=False):
            self._rule = gui.add_dropdown("primitive", [NONE])
            self._rule.on_update(guard(None, self._show_rule))
            self._rules_said = gui.add_html("")
            self.button("Take its text above", self._edit, self._rules_said)
            self.button(
                "Remove it", lambda: self.remove(self._rule.value), self._rules_said, color="red"
            )
            self._rule_text = gui.add_html("")
        with gui.add_folder("Words of rules", expand_by_default=False):
            self._word = gui.add_text("word", "", hint="Such as carried_off; empty lists all.")
            self._word_said = self.button(
                "Explain it", lambda: self.words(self._word.value.strip())
            )
            self._words = gui.add_html("")
        with gui.add_folder("Audit", expand_by_default=False):
            self._audit_said = self.button("Audit every possible segment", self.audit)

    def captured(self) -> None:
        """List what is unknown, and the rules that count."""
        settings, opened = self.window.settings, self.window.active
        names = [rule.name for rule in rules_of(settings.rule_base(), actionary=settings.actionary)]
        self._rule.options = [NONE, *names]
        self._general.options = [NONE, *names]
        self._over.options = [OVER, "all", *names]
        segments = opened.observation.segments if opened and opened.observation else ()
        unknown = [str(SegmentAddress(e.ee, e.index)) for e in segments if not e.known]
        self._unknown.options = [NONE, *unknown]
        self._unknown.value = NONE

    def chosen(self) -> None:
        """Say what fitted the chosen segment, and how far."""
        segment = self.window.segment
        if segment is None:
            return
        fitted = f"It is {segment.name}." if segment.known else f"{unknown_note(segment)}."
        self._about.content = html.text(
            f"{SegmentAddress(segment.ee, segment.index)}, {segment.start_s:.2f} to "
            f"{segment.end_s:.2f} s, about {', '.join(segment.objects) or 'nothing'}. "
            f"{fitted}\nIts features: {features(segment.features)}"
        )

    def _choose(self) -> None:
        if self._unknown.value != NONE:
            self.window.choose(self._unknown.value)

    # One rule

    def draft(self) -> str:
        """Draft the smallest rule that tells the chosen segment from the others."""
        opened, _ = self.window.need()
        segment = self.window.segment
        if segment is None:
            raise CaparError("choose a segment first: above, or with the keys N and P")
        if not opened.place:
            raise CaparError(
                f"{opened.trial.name} is in this window only; save it as a capture, and open that"
            )
        settings, name = self.window.settings, self._name.value.strip()
        general = "" if self._general.value == NONE else self._general.value
        words = {"definition": self._definition.value, "verb": self._verb.value.strip()}
        source = f"{opened.place}/{SegmentAddress(segment.ee, segment.index)}"

        def work(report: Callable[[str, float], None]) -> str:
            report("looking for what tells it from other segments", 0.3)
            base = settings.rule_base()
            return rule_from_segment(name, source, rules=base, general=general, **words)

        def done(text: Any) -> None:
            self.text.value = str(text)
            self._draft_said.content = html.message("drafted; read it below", good=True)

        self.window.work(f"drafting {name or 'a rule'}", self._draft_said, work, done)
        return ""

    @contextmanager
    def _file(self) -> Any:
        """The text as a file of its own, outside of the rules that count."""
        text = self.text.value
        with TemporaryDirectory() as folder:
            path = Path(folder) / "draft.lp"
            path.write_text(text, encoding="utf-8")
            names = introduced(path)
            if not names:
                raise RuleError('the text introduces no primitive: it states no primitive("Name").')
            try:
                yield path.rename(path.with_name(f"{_stem(names[0])}.lp"))
            except CaparError as error:
                raise RuleError(str(error).replace(f"{folder}/", "")) from None

    def _others(self, path: Path | None = None) -> tuple[Path, ...]:
        """The rule files that people wrote, without one of that name."""
        settings = self.window.settings
        files = user_rules(settings.rules, actionary=settings.actionary)
        return tuple(each for each in files if path is None or each.name != path.name)

    def check(self) -> str:
        """Say what is wrong with the text; nothing of it is run."""
        with self._file() as path:
            found = check(path, profile=self.window.settings.profile, beside=self._others(path))
            lines = "\n".join(map(str, found)).replace(f"{path.parent}/", "")
            if errors(found):
                raise RuleError(lines)
        return lines or "nothing is wrong"

    def effect(self) -> str:
        """Show what would have another name in what is open and what is stored."""
        settings = self.window.settings
        with self._file() as path:
            beside = self._others(path)
            found = check(path, profile=settings.profile, beside=beside)
            require(path, [each for each in found if each.code != "ambiguous"])
            before = settings.rule_base()
            after = admitted_profile(settings.profile, added=(*beside, path))
            changes = renamed(self._seen(), before=before, after=after)
        self._changes.content = _table(changes)
        return f"segments that would change: {len(changes)}; it does not count yet"

    def _seen(self) -> dict[str, Trial]:
        """What is stored, and what is open beside it."""
        base, seen = self.window.settings.rule_base(), {}
        for each in self.window.captures:
            if each.seen is not None:
                facts = each.seen.measures.measurements.facts
                seen[each.trial.name] = Trial(tuple(steady(facts) if base.steady else facts))
        return {**seen, **(stored(self._place, profile=base.name).seen if self._place else {})}

    @property
    def _place(self) -> str | None:
        """The Actionary, where something was observed in it."""
        place = self.window.settings.actionary
        return place if place and (Path(place) / DATA_FOLDER).is_dir() else None

    def keep(self) -> str:
        """Add the rule to those that count, and rename what it changes: both, or neither."""
        settings, folder = self.window.settings, self.window.settings.rules_folder
        self.window.folders.inside(folder.absolute())
        over = () if self._over.value == OVER else (self._over.value,)
        purpose = self._purpose.value.strip()
        if purpose and not purpose.isidentifier():
            raise CaparError(f"{purpose!r} is no purpose; write one word, like PickUp")
        with self._file() as path:
            options: dict[str, Any] = {
                "folder": folder, "base": settings.profile, "over": over,
                "beside": self._others(path),
            }  # fmt: skip
            changes: Sequence[Renamed] = ()
            if self._place:
                added, effect = add_reclassifying(
                    path, actionary=self._place, captures=self.window.folders.roots, **options
                )
                changes = effect.changes
            else:
                added = add_rule(path, **options)
        name = introduced(added)[0]
        stated = self._state_purpose(name, purpose)
        self._undo.append((name, lambda: self._take_back(added, stated)))
        if changes:
            self._changes.content = _table(changes)
        self.window.rules_changed()
        return f"{name} counts now: {self.window.folders.named(added)}"

    def _state_purpose(self, action: str, purpose: str) -> tuple[OpenCapture, Path, str] | None:
        """Add to the capture.toml what an action is done for; the file and its text before."""
        opened = self.window.active
        if not purpose or opened is None or not opened.place:
            return None
        path = find_place(opened.place)[0]
        before = path.read_text("utf-8")
        path.write_text(
            with_table(before, "purpose", {"purpose": purpose, "action": action}), "utf-8"
        )
        opened.trial = read_capture(opened.place)
        return opened, path, before

    def undo(self) -> str:
        """Take back the rule that was kept last."""
        if not self._undo:
            raise CaparError("nothing was kept in this window that could be undone")
        name, back = self._undo[-1]
        back()
        self._undo.pop()
        self._changes.content = ""
        self.window.rules_changed()
        return f"{name} does not count any more"

    def _take_back(self, path: Path, stated: tuple[OpenCapture, Path, str] | None) -> None:
        settings = self.window.settings
        if stated is not None:  # first: what is stored was observed with the text before
            opened, file, before = stated
            file.write_text(before, "utf-8")
            opened.trial = read_capture(opened.place)
        if self._place:
            after = admitted_profile(settings.profile, added=self._others(path))
            remove_reclassifying(
                path, actionary=self._place, after=after, captures=self.window.folders.roots
            )
        else:
            path.unlink()

    # All rules

    def _show_rule(self) -> None:
        if self._rule.value == NONE:
            return
        found = rule_of(self.window.settings.rule_base(), self._rule.value)
        above = f" It is a kind of {', '.join(found.general)}." if found.general else ""
        said = f"{found.definition} ({found.origin}; verb: {found.verb or 'none'}.){above}"
        self._rule_text.content = html.text(said) + html.code(Path(found.file).read_text("utf-8"))

    def _edit(self) -> str:
        if self._rule.value == NONE:
            raise CaparError("choose a primitive first")
        found = rule_of(self.window.settings.rule_base(), self._rule.value)
        self.text.value = Path(found.file).read_text("utf-8")
        return "its text is above; under the same name it counts only after the old one is removed"

    def remove(self, name: str) -> str:
        """Take a rule of the user's away; one that ships stays."""
        if name == NONE:
            raise CaparError("choose a primitive first")
        every = self._others()
        path = removable(name, files=every, every=every)
        self.window.folders.inside(path.absolute())
        text = path.read_text("utf-8")
        self._take_back(path, None)

        def back() -> None:
            if path.exists():
                raise FileError(path, "exists already.", "Remove that rule first.")
            path.write_text(text, "utf-8")

        self._undo.append((name, back))
        self.window.rules_changed()
        return f"{name} does not count any more; Undo brings it back"

    def words(self, name: str) -> str:
        """Explain a word of rules, or list them all."""
        found = glossary(self.window.settings.rule_base())
        words = found.find(name) if name else found.words
        if not words:
            raise UnknownNameError("word", name, [word.name for word in found.words])
        rows = [(f"{word}", word.meaning) for word in words]
        self._words.content = html.table(rows, ("word", "meaning"))
        return ""

    def audit(self) -> str:
        """Audit the rule base over every possible segment, in the background."""
        base = self.window.settings.rule_base()

        def work(report: Callable[[str, float], None]) -> Any:
            report("every possible set of features", 0.3)
            return audit(base)

        def done(found: Any) -> None:
            said = "the rules are clean" if found.clean else "the rules are not clean"
            clashes = [f"{each.first} and {each.second} fit the same" for each in found.ambiguous]
            rest = [f"shadowed: {name}" for name in found.shadowed]
            rest += [f"never fits: {name}" for name in found.unreachable]
            lines = [f"{found.possible} feature sets can be; {said}", *clashes, *rest]
            self._audit_said.content = html.message("\n".join(lines), good=found.clean)

        self.window.work("the audit", self._audit_said, work, done)
        return ""


def _stem(name: str) -> str:
    """The name of the file of a primitive: ``move_obj_to``."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def _table(changes: Sequence[Renamed]) -> str:
    if not changes:
        return html.note("No segment would have another name.")
    rows = [
        (
            str(SegmentAddress(each.ee, each.index, each.capture)),
            f"{each.start_s:.2f} s",
            " or ".join((each.before, *each.before_others)),
            " or ".join((each.after, *each.after_others)),
        )
        for each in changes
    ]
    return html.table(rows, ("segment", "from", "before", "after"))
