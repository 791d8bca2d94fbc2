"""Many captures: one line each, failures told, one writer, and taken up again after a kill."""

import json
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from bundles import DRINKING
from shell import capar, refused, run

from capar.model.errors import CaparError
from capar.pipelines.many import observe_many
from capar.pipelines.observation import observe
from extractors.readers.bundle.patterns import find_captures
from kb import Actionary
from kb.exchange import export


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Five captures of the demo's motion under names of their own."""
    folder = tmp_path_factory.mktemp("many") / "study"
    text = (DRINKING / "capture.toml").read_text()
    for n in range(5):
        shutil.copytree(DRINKING, folder / f"c{n}")
        own = text.replace('name = "drink_from_mug_tall_man"', f'name = "c{n}"')
        (folder / f"c{n}" / "capture.toml").write_text(own)
    return folder


def content(place: Path) -> list[str]:
    """What an Actionary says of its observations, without when they were made."""
    with Actionary.open(place, read_only=True) as book:
        return [export(book.store, "nquads", observation=each.name) for each in book.observations()]


def test_patterns_mean_folders_takes_and_what_is_below(study: Path, tmp_path: Path) -> None:
    every = [str(study / f"c{n}") for n in range(5)]
    assert find_captures([str(study)]) == every
    assert find_captures([str(study / "c[01]"), every[1], every[3]]) == [*every[:2], every[3]]
    bundle = tmp_path / "bundle"
    shutil.copytree(DRINKING, bundle)
    text = (bundle / "capture.toml").read_text()
    (bundle / "capture.toml").write_text(f'takes = ["a1", "a2", "b"]\n{text}')
    takes = [f"{bundle}:{each}" for each in ("a1", "a2", "b")]
    assert find_captures([str(bundle)]) == takes
    assert find_captures([f"{bundle}:a*"]) == takes[:2]
    odd = bundle.rename(tmp_path / "odd [1]")
    assert find_captures([str(odd)])[0] == f"{odd}:a1"
    bundle = odd.rename(bundle)
    for pattern, wrong in ((f"{bundle}:x*", "Its takes are: a1, a2, b"), ("no*ne", "no capture")):
        with pytest.raises(CaparError, match=wrong):
            find_captures([pattern])


def test_several_processes_keep_what_one_keeps_and_in_its_order(
    study: Path, tmp_path: Path
) -> None:
    seen = {}
    for jobs in (1, 2):
        place = tmp_path / f"by_{jobs}"
        seen[jobs] = [
            each.observation
            for each in observe_many([f"{study}/c[0-2]"], jobs=jobs, actionary=place)
        ]
    assert seen[1] == seen[2]
    assert seen[1][0] == observe(study / "c0")
    assert content(tmp_path / "by_1") == content(tmp_path / "by_2")


def test_a_killed_run_goes_on_where_it_was(study: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-c", "from capar.cli import main; main()", "observe", str(study),
               "--jobs", "2", "--new", "--actionary"]  # fmt: skip
    killed = subprocess.Popen([*command, str(tmp_path / "killed")], stdout=subprocess.PIPE)
    assert killed.stdout is not None
    assert killed.stdout.readline().startswith(b"1/5")
    killed.send_signal(signal.SIGKILL)
    killed.communicate()
    deadline = time.monotonic() + 60.0
    with Actionary.open(tmp_path / "killed", read_only=True) as book:
        before = [each.name for each in book.observations()]
    assert 1 <= len(before) < 5
    again = capar("observe", study, "--jobs", 2, "--wait", 30, "--actionary", tmp_path / "killed")
    assert again.exit_code == 0, again.output
    for name in before:
        assert f"{name}: is kept already" in again.stdout
    assert time.monotonic() < deadline
    run("observe", study, "--new", "--actionary", tmp_path / "whole")
    assert content(tmp_path / "killed") == content(tmp_path / "whole")


def test_failures_are_told_at_the_end_with_their_commands(study: Path, tmp_path: Path) -> None:
    some = tmp_path / "some"
    for n in (0, 1):
        shutil.copytree(study / f"c{n}", some / f"c{n}")
    (some / "c0" / "motion.csv").write_text("broken\n")
    done = capar("observe", some, "--json")
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    assert [(row["segments"], bool(row["error"])) for row in rows] == [(0, True), (7, False)]
    told = str(done.exception)
    assert "1 of 2 captures failed" in told
    assert f"capar observe {some / 'c0'}\n" in told
    assert "motion.csv: is of no format known here" in told
    assert "capar observe" not in capar("observe", some, "--quiet").stdout
    assert "of many captures there is no --plot" in refused(
        "observe", some, "--plot", tmp_path / "a.png"
    )


def test_a_process_that_dies_is_told_with_its_capture(
    study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "executable", "/bin/true")
    with pytest.raises(CaparError, match=r"the process that observed .*c0 died.*--jobs"):
        list(observe_many([study], jobs=2))


@pytest.mark.long
def test_a_dask_cluster_keeps_what_one_process_keeps(
    study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    distributed = pytest.importorskip("distributed", reason="pip install 'capar[cluster]'")
    monkeypatch.chdir(study.parent)  # places may be relative, and workers elsewhere
    three = ["study/c[0-2]"]
    seen = [each.observation for each in observe_many(three, actionary=tmp_path / "one")]
    monkeypatch.chdir(tmp_path)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path)
    ) as cluster:
        address = cluster.scheduler_address
        monkeypatch.chdir(study.parent)
        by = {"scheduler": address, "actionary": tmp_path / "cluster"}
        assert [each.observation for each in observe_many(three, **by)] == seen
        again = [each.known for each in observe_many(three, **by)]
    assert again == [each.capture for each in seen if each]
    assert content(tmp_path / "cluster") == content(tmp_path / "one")


def test_a_cluster_that_is_not_there_is_told(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed", reason="pip install 'capar[cluster]'")
    monkeypatch.setattr("capar.pipelines.many.CONNECT_S", 0.5)
    with pytest.raises(CaparError, match=r"no dask scheduler answers at tcp://127\.0\.0\.1:9"):
        list(observe_many([study], scheduler="tcp://127.0.0.1:9"))
