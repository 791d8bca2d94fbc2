"""The site of docs/ builds without a warning: every page, link, anchor and documented name."""

import os
import re
import subprocess
import sys
from html import unescape
from pathlib import Path

import pytest

import capar
from capar.cli import COMMANDS

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    for needed in ("mkdocs", "material", "mkdocstrings"):
        pytest.importorskip(needed, reason="pip install 'capar[docs]'")
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT, env=os.environ | {"NO_MKDOCS_2_WARNING": "1"},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "WARNING" not in done.stderr, done.stderr
    return folder


@pytest.mark.long
def test_the_references_have_every_command_and_public_name(site: Path) -> None:
    commands = unescape((site / "docs" / "commands.html").read_text())
    for name in COMMANDS:
        assert re.search(rf"<h2[^>]*>capar {name}\b", commands), name
    assert "--per-frame" in commands
    names = (site / "docs" / "python.html").read_text()
    for name in capar.__all__:
        assert f'id="capar.{name}"' in names, name


@pytest.mark.long
def test_no_page_needs_the_network_or_shows_raw_marks(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 30
    for page in pages:
        text = page.read_text()
        loaded = re.findall(r'<(?:script|link|img)\b[^>]*\b(?:src|href)="(https?:[^"]+)"', text)
        assert not [each for each in loaded if "w3id.org" not in each], page
        for paragraph in re.findall(r"<p>(.*?)</p>", text, re.S):
            assert not re.search(r"\n(\* |\|---|```)", paragraph), f"{page}: {paragraph[:200]}"
