"""Files that the system does not give end a command with one sentence, and so does SIGINT.

What a command writes is there whole or not at all.
"""

import errno
import os
import resource
import signal
import stat
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from bundles import DRINKING
from commands import capar

from capar.cli.output import REMEDIES, error_message, written

CAPAR = Path(sys.executable).parent / "capar"
SIP = """%* Sip: it is held to what it touches. *%
primitive("Sip").
feature_row("Sip", any, "111", "111", "11", "00").
verb("Sip", "sip").
"""


@pytest.fixture
def closed(tmp_path: Path) -> Iterator[Path]:
    """A folder that may be read only, with a rule in it; beside it a rule that may not be read."""
    place = tmp_path / "ro"
    place.mkdir()
    (place / "sip.lp").write_text(SIP)
    (tmp_path / "unread").mkdir()
    (tmp_path / "unread" / "sip.lp").write_text(SIP)
    (tmp_path / "unread" / "sip.lp").chmod(0)
    (tmp_path / "unread" / "motion.csv").write_text("time\n")
    (tmp_path / "unread" / "motion.csv").chmod(0)
    (tmp_path / "kept.svg").write_text("old")
    (tmp_path / "kept.svg").chmod(stat.S_IRUSR)
    (tmp_path / "shut").mkdir(mode=0)
    place.chmod(stat.S_IRUSR | stat.S_IXUSR)
    yield tmp_path
    place.chmod(stat.S_IRWXU)
    (tmp_path / "shut").chmod(stat.S_IRWXU)


FAULTS = (
    (("rules", "remove", "Sip", "--rules", "ro"), "ro/sip.lp", "Permission denied"),
    (("rules", "new", "Sip", "--features", "111,111,11,00", "--out", "ro/x.lp"), "ro/x.lp",
     "Permission denied"),
    (("rules", "list", "--rules", "unread"), "unread/sip.lp", "cannot be read"),
    (("rules", "list", "--rules", "shut"), "shut", "not readable"),
    (("inspect", "unread/motion.csv"), "unread/motion.csv", "Grant yourself read permission"),
    (("explain", DRINKING, "right_hand/2", "--plot", "ro/k.svg"), "ro/k.svg", "Permission denied"),
    (("explain", DRINKING, "right_hand/2", "--plot", "nowhere/k.svg"), "nowhere/k.svg",
     "No such file or directory"),
    (("explain", DRINKING, "right_hand/2", "--plot", "kept.svg"), "kept.svg", "Permission denied"),
    (("new-capture", DRINKING / "motion.csv", "-o", "ro/a/b"), "ro/a", "Permission denied"),
)  # fmt: skip


@pytest.mark.parametrize(("arguments", "where", "what"), FAULTS)
def test_what_cannot_be_used_is_named_and_ends_with_two(closed, arguments, where, what):
    before = sorted(closed.rglob("*.*"))
    done = capar(*arguments, cwd=closed, ordinary=True)
    assert done.returncode == 2, done.stderr
    assert "Traceback" not in done.stderr
    assert where in done.stderr
    assert what in done.stderr
    assert sorted(closed.rglob("*.*")) == before


@pytest.mark.parametrize("number", [*REMEDIES, errno.EIO])
def test_every_fault_says_what_where_and_what_would_be_right(number):
    what = os.strerror(number)
    assert error_message(OSError(number, what, "a/b")).startswith(f"a/b: cannot be used: {what}. ")
    assert error_message(OSError(number, what, "a/b")).count(". ") == 1


def test_an_interrupt_is_told_once_without_a_traceback(tmp_path):
    """The whole group is interrupted, as a terminal does it, while the command reads its input."""
    fifo = tmp_path / "drink.motion.toml"
    os.mkfifo(fifo)
    process = subprocess.Popen(
        [str(CAPAR), "test", str(fifo)], cwd=tmp_path, text=True, start_new_session=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    with fifo.open("w"):  # opens once the command has begun to read
        time.sleep(0.2)
        os.killpg(process.pid, signal.SIGINT)
        out, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert out == ""
    assert errors == "capar: interrupted; nothing was left half-written\n"


def test_output_that_nobody_reads_on_is_no_fault(tmp_path):
    done = subprocess.run(
        ["sh", "-c", f"{CAPAR} rules list --json | head -c 1"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.stdout == "["
    assert done.stderr == ""


def test_a_fault_while_a_file_is_written_leaves_the_old_one_and_no_draft(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def half() -> None:
        with written(path) as draft:
            draft.write_text("hal")
            assert path.read_text() == "old"
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(OSError, match="No space left") as caught:
        half()
    assert error_message(caught.value).startswith(
        f"{path}: cannot be used: No space left on device. "
    )
    assert [(each.name, each.read_text()) for each in tmp_path.iterdir()] == [("a.txt", "old")]


def test_a_file_keeps_its_rights_and_links_to_it_and_a_device_stays_one(tmp_path):
    path, link = tmp_path / "a.txt", tmp_path / "link.txt"
    path.write_text("old")
    path.chmod(0o640)
    link.symlink_to(path)
    with written(link) as draft:
        draft.write_text("new")
    assert link.is_symlink()
    assert path.read_text() == "new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    with written(Path(os.devnull)) as draft:
        draft.write_text("gone")
    assert Path(os.devnull).is_char_device()


@pytest.mark.parametrize(
    "arguments",
    [
        ("observe", DRINKING, "--plot", "k.svg"),
        ("new-capture", DRINKING / "motion.csv", "--force", "-o", "k.toml"),
        ("report", "linguistics", "--out", "k.txt"),
    ],
)
def test_a_command_that_cannot_write_on_names_the_file_and_leaves_the_old_one(arguments, tmp_path):
    path = tmp_path / arguments[-1]
    path.write_text("old")
    compiles_nothing = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [str(CAPAR), *map(str, arguments)], cwd=tmp_path, capture_output=True, text=True,
        check=False, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)),
        env=compiles_nothing,
    )  # fmt: skip
    assert done.returncode == 2, done.stderr
    assert f"capar: {path.name}: " in done.stderr
    assert "File too large" in done.stderr
    assert [(each.name, each.read_text()) for each in tmp_path.iterdir()] == [(path.name, "old")]
