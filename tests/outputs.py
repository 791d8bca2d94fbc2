"""Record what users get, and compare it with an earlier record.

    python tests/outputs.py FOLDER                      # everything, into FOLDER
    python tests/outputs.py FOLDER --against EARLIER    # and print what differs
    python tests/outputs.py FOLDER --only observe --match 'demo|box'

Sections: ``observe`` (demo and every recording: segments, borders, objects, PARs, movers, counts
and hashes of each kind of fact), ``scenes`` (one in ten of the batteries), ``questions`` (every
named question over an Actionary of six captures), ``report``, ``regenerate`` (ten: gates and PAR),
``parse`` (committed sentences), ``mistakes`` (exit code and first line) and ``commands`` (every
command with its options). Wording of explanations, descriptions and notices is not recorded.
Recordings are found as the tests find them: ``CAPAR_DATA``, else ``../shared/data``.
"""

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
DEMO = "capar/demo/drink_from_mug"
QUESTIONS_FROM = (
    DEMO,
    "examples/pyomeca_box_lift",
    "examples/bimacs_optitrack:take0",
    "examples/bimacs_optitrack:take3",
    "examples/omomo_intermimic/hands.toml:sub2_largetable_008",
    "examples/manipnet:mug1",
)
PARAMETERS = {
    "action": "MoveObj",
    "object": "mug",
    "goal": "table",
    "levin": "11.2",
    "lemma": "move",
    "capture": "drink_from_mug",
    "body": "mug",
    "time": "2.5",
    "first": "drink_from_mug",
    "second": "drink_from_mug",
}
"""A value for each parameter that a named question demands."""

REGENERATIONS = (
    ("drink", "child", ()),
    ("drink", "woman", ()),
    ("touch", "child", ()),
    ("slide", "woman", ()),
    ("carry", "child", ()),
    ("pick_up", "man", ()),
    ("pour", "child", ()),
    ("turn", "woman", ()),
    ("drink", "child", ("--effort", "sudden=0.6")),
    ("carry", "woman", ("--hand", "left")),
)
MISTAKES = (
    ("observe", "no/such/folder"),
    ("observe", DEMO, "--profile", "theses"),
    ("observe", DEMO, "--set", "contact_dropuot_s=1"),
    ("observe", "README.md"),
    ("explain", DEMO, "rihgt_hand/2"),
    ("explain", DEMO, "right_hand/99"),
    ("explain", DEMO, "right_hand/2", "--why-not", "Reahc"),
    ("inspect", "LICENSE"),
    ("inspect", "no_such_file.c3d"),
    ("query", "tuoching"),
    ("query", "touching"),
    ("query", "touching", "object=mug", "colour=red"),
    ("query", "SELECT ?x WHERE {"),
    ("show", "NoSuchAction"),
    ("agent", "show", "nobody"),
    ("object", "show", "nothing"),
    ("forget", "no_such_capture"),
    ("correct", "no_such/right_hand/3", "--name", "Sip", "--by", "Ada"),
    ("export", "x.trig", "--actionary", "no_such_folder"),
    ("export", DEMO, "--format", "pdd"),
    ("regenerate", DEMO, "--agent", "giant", "--output", "x"),
    ("perform", "dance", "--output", "x"),
    ("rules", "show", "Lfit"),
    ("rules", "check", "no_such.lp"),
    ("verb", "carryy"),
    ("evaluate", "no_such.toml"),
    ("test", "no_such.motion.toml"),
    ("devices", "nothing:/dev/none"),
    ("serve", "--actionary", "no_such_folder"),
    ("nosuchcommand",),
)


SEGMENT = ("index", "first", "last", "start_s", "end_s", "name", "objects", "purpose", "general")
"""What is recorded of a segment."""


def run(*arguments: str, folder: str | Path = ROOT, timeout: float = 900) -> tuple[int, str, str]:
    """A command of the command line: its exit code, standard output and standard error."""
    done = subprocess.run(
        [sys.executable, "-c", "from capar.cli import main; main()", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
        stdin=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"},
    )
    return done.returncode, done.stdout, done.stderr


def digest(value: object) -> str:
    """Eight hex digits that stand for a value."""
    text = json.dumps(value, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:8]


def first_line(text: str) -> str:
    """The first line of a message."""
    return next((line.strip() for line in text.splitlines() if line.strip()), "")


def observe(place: str) -> Any:
    """What ``capar observe --json`` prints of a capture, without prose."""
    code, out, err = run("observe", place, "--json", "--on-unknown", "keep")
    if code:
        return {"exit": code, "error": first_line(err)}
    seen = json.loads(out)
    kinds: dict[str, list[str]] = {}
    for fact in seen["facts"]:
        kinds.setdefault(fact.split("(")[0], []).append(fact)
    movers = ("moved_by", "moves_with", "unmoved", "moving", "touching")
    return {
        "segments": [
            [
                link["ee"],
                *(each[key] for key in SEGMENT),
                " ".join(each["features"].values()).strip(),
            ]
            for link in seen["links"]
            for each in link["segments"]
        ],
        "relations": digest([link["segments"] for link in seen["links"]]),
        "objects": seen["objects"],
        "par": seen["complex_par"],
        "upars": digest(seen["upars"]),
        "ipars": digest(seen["ipars"]),
        "joint": seen["joint"],
        "locations": digest(seen["locations"]),
        "styles": digest(seen["styles"]),
        "forces": seen["forces"],
        "guides": digest(seen["guides"]),
        "tracks": digest(seen["tracks"]),
        "notices": sorted({each["code"] for each in seen["notices"]}),
        "movers": {kind: sorted(kinds[kind]) for kind in movers if kind in kinds},
        "facts": {kind: [len(rows), digest(sorted(rows))] for kind, rows in sorted(kinds.items())},
        "calibration": digest(
            {key: value for key, value in seen["calibration"].items() if key != "thresholds"}
        ),
    }


def scene(name: str) -> Any:
    """Steps of every end-effector of a scene of a battery: BATTERY/NAME."""
    battery, _, which = name.partition("/")
    done = subprocess.run(
        [sys.executable, "-m", "scenes.score", battery, "--scene", which, "--json"],
        cwd=ROOT / "tests",
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    if done.returncode:
        return {"error": done.stderr[-300:]}
    return [[each["ee"], each["found"], each["error"]] for each in json.loads(done.stdout)]


def questions(_: str) -> Any:
    """The rows of every named question over an Actionary of several captures."""
    rows: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        known = str(Path(folder) / "known")
        for place in QUESTIONS_FROM:
            run("observe", place, "--actionary", known, "--on-unknown", "keep")
        listed = json.loads(run("query", "--list", "--json")[1])
        for each in listed:
            name = each["name"]
            needed = re.findall(r"(?<![\[\w])(\w+)(?![\]\w])", str(each.get("parameters", "")))
            given = [f"{key}={PARAMETERS[key]}" for key in needed if key in PARAMETERS]
            code, out, err = run("query", name, *given, "--json", "--actionary", known)
            rows[name] = _answer(code, out, err)
        code, out, _err = run("export", str(Path(folder) / "x.nt"), "--actionary", known)
        rows["show"] = run("show", "MoveObj", "--actionary", known)[0]
    return rows


def _answer(code: int, out: str, err: str) -> Any:
    if code:
        return {"exit": code, "error": re.sub(r"\S*/tmp\S*", "FOLDER", first_line(err))}
    found = json.loads(out)
    table = found if isinstance(found, list) else found.get("rows", found)
    volatile = ("observed_at", "when", "version", "observed", "message", "text", "tool", "rules")
    if isinstance(table, list):
        table = [
            {key: value for key, value in row.items() if key not in volatile}
            if isinstance(row, dict)
            else row
            for row in table
        ]
        return {"rows": len(table), "digest": digest(table), "first": table[:3]}
    return table


def report(kind: str) -> Any:
    """Rows of the linguistic report of the demo, or the answer of a verb."""
    with tempfile.TemporaryDirectory() as folder:
        known = str(Path(folder) / "known")
        run("observe", DEMO, "--actionary", known)
        if kind == "linguistics":
            code, out, err = run("report", "linguistics", "--json", "--actionary", known)
        else:
            code, out, err = run("verb", kind, "--json", "--actionary", known)
    if code:
        return {"exit": code, "error": first_line(err)}
    found = json.loads(out)
    return found if kind != "linguistics" else {"digest": digest(found), "report": found}


def regenerate(name: str) -> Any:
    """Gates and PAR of a regeneration: ACTION, AGENT and options."""
    action, agent, *options = name.split("+")
    with tempfile.TemporaryDirectory() as folder:
        run("perform", action, "--output", "recorded", folder=folder)
        arguments = ("recorded", "--agent", agent, "--output", "made", *options)
        code, out, err = run("regenerate", *arguments, "--json", folder=folder)
        seen = observe(str(Path(folder) / "made")) if (Path(folder) / "made").exists() else None
    if not out.strip().startswith("{"):
        return {"exit": code, "error": first_line(err)}
    made = json.loads(out)
    gates = [
        [each.get("name"), each.get("passed", each.get("passes")), each.get("value")]
        for each in made.get("gates", made.get("quality", {}).get("gates", []))
    ]
    steps = (
        [
            [step["action"], step["objects"]]
            for link in seen["par"]["links"]
            for step in link["steps"]
        ]
        if seen and "par" in seen
        else seen
    )
    return {"exit": code, "gates": gates, "par": steps}


def sentences() -> Iterator[str]:
    """Every committed sentence that is read."""
    for path in sorted((ROOT / "tests/kb/language").glob("instructions_*.txt")):
        yield from (line.strip() for line in path.read_text().splitlines() if line.strip())
    toml = ROOT / "tests/regeneration/sentences.toml"
    if toml.exists():
        yield from re.findall(r'^(?:say|sentence|text) = "(.+)"$', toml.read_text(), re.MULTILINE)


def parse(_: str) -> Any:
    """What ``capar parse`` reads of each committed sentence."""
    found = {}
    for text in sentences():
        code, out, err = run("parse", text, "--json")
        read = out.strip().startswith(("{", "["))
        found[text] = json.loads(out) if read else [code, first_line(err)]
        if read and isinstance(found[text], dict) and "sparql" in found[text]:
            found[text]["sparql"] = re.sub(r"^#.*\n", "", found[text]["sparql"], flags=re.MULTILINE)
    return found


def mistakes(_: str) -> Any:
    """Exit code and first line of a mistake."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in ("capar", "README.md", "LICENSE"):
            (Path(folder) / name).symlink_to(ROOT / name)
        for arguments in MISTAKES:
            code, _out, err = run(*arguments, folder=folder, timeout=120)
            found[" ".join(arguments)] = [code, first_line(err)]
    return found


COMMAND_TREE = """
import json, click, typer, capar.cli
def walk(command, path):
    names = [name for each in command.params for name in (*each.opts, *each.secondary_opts)]
    found = {" ".join(path): sorted(name for name in names if name.startswith("--"))}
    if hasattr(command, "list_commands"):
        context = click.Context(command)
        for name in command.list_commands(context):
            found.update(walk(command.get_command(context, name), [*path, name]))
    return found
print(json.dumps(walk(typer.main.get_command(capar.cli.app), [])))
"""


def commands(_: str) -> Any:
    """Every command with the names of its options."""
    done = subprocess.run(
        [sys.executable, "-c", COMMAND_TREE], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


def places() -> Iterator[str]:
    """The demo, and every recording of the examples."""
    yield DEMO
    for path in sorted((ROOT / "examples").glob("*/*.toml")):
        text = path.read_text()
        if path.name.endswith((".scene.toml", "evaluation.toml", "mapping.toml")) or (
            "[[sensor" not in text and "[[object" not in text and "[takes" not in text
        ):
            continue
        place = str(path.relative_to(ROOT))
        yield from [f"{place}:{take}" for take in _takes(path)] or [place]


def _takes(path: Path) -> list[str]:
    script = (
        "import sys, json\n"
        "try:\n    from extractors.readers.bundle.capture_toml import takes\n"
        "except ImportError:\n    from extractors.readers.bundle import takes\n"
        "print(json.dumps(takes(sys.argv[1])))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, str(path)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    return json.loads(done.stdout) if done.returncode == 0 else []


def scenes() -> Iterator[str]:
    """One in ten of the scenes of each battery."""
    script = (
        "import json, importlib\n"
        "names = [b + '/' + s for b in ('hands', 'objects', 'household', 'people')\n"
        "         for s in sorted(importlib.import_module('scenes.' + b).SCENES)[::10]]\n"
        "print(json.dumps(names))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=ROOT / "tests",
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        check=True,
    )
    yield from json.loads(done.stdout)


SECTIONS: dict[str, tuple[Callable[[str], Any], Callable[[], Any]]] = {
    "commands": (commands, lambda: ["all"]),
    "mistakes": (mistakes, lambda: ["all"]),
    "parse": (parse, lambda: ["all"]),
    "report": (report, lambda: ["linguistics", "carry", "hit", "put"]),
    "questions": (questions, lambda: ["all"]),
    "regenerate": (regenerate, lambda: ["+".join((a, b, *c)) for a, b, c in REGENERATIONS]),
    "scenes": (scene, scenes),
    "observe": (observe, places),
}


def flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Every leaf of a value, with the way to it."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from flat(part, f"{path}/{key}")
    elif isinstance(value, list) and any(isinstance(part, dict | list) for part in value):
        for index, part in enumerate(value):
            yield from flat(part, f"{path}/{index}")
    else:
        yield path, value


def differences(old: Any, new: Any) -> list[str]:
    """A line for each leaf that differs."""
    was, now = dict(flat(old)), dict(flat(new))
    return [
        f"{path}: {was.get(path, 'nothing')} -> {now.get(path, 'nothing')}"
        for path in sorted(was.keys() | now.keys())
        if was.get(path) != now.get(path)
    ]


def main() -> int:
    """Record, and compare where asked."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--against", type=Path, help="folder of an earlier record")
    parser.add_argument("--only", action="append", choices=SECTIONS, help="only this section")
    parser.add_argument("--match", default="", help="only items that this pattern finds")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--lines", type=int, default=8, help="lines printed an item")
    options = parser.parse_args()
    if "CAPAR_DATA" not in os.environ:
        os.environ["CAPAR_DATA"] = str(ROOT.parent / "shared" / "data")
    work = [
        (section, item)
        for section in options.only or SECTIONS
        for item in SECTIONS[section][1]()
        if re.search(options.match, f"{section} {item}")
    ]
    changed = 0
    with ProcessPoolExecutor(options.jobs) as pool:
        tasks = {pool.submit(SECTIONS[section][0], item): (section, item) for section, item in work}
        for count, task in enumerate(as_completed(tasks), 1):
            section, item = tasks[task]
            name = re.sub(r"[^\w.+=-]+", "_", item) + ".json"
            path = options.folder / section / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps(task.result(), indent=1, sort_keys=True) + "\n")
            if options.against:
                earlier = options.against / section / name
                if not earlier.exists():
                    lines = ["not in the earlier record"]
                else:
                    old = json.loads(earlier.read_text())
                    lines = differences(old, json.loads(path.read_text()))
                changed += bool(lines)
                if lines:
                    sys.stdout.write(f"{section} {item}: {len(lines)} differences\n")
                    sys.stdout.writelines(f"    {line[:200]}\n" for line in lines[: options.lines])
                    sys.stdout.flush()
            sys.stderr.write(f"\r{count} of {len(work)}")
    sys.stderr.write("\n")
    if options.against:
        sys.stdout.write(f"{changed} of {len(work)} differ\n")
    return int(bool(changed))


if __name__ == "__main__":
    sys.exit(main())
