"""Validate a GLB file with the Khronos glTF validator (npm package gltf-validator), where it is.

``NODE_PATH`` says where Node.js finds it: the ``node_modules`` folder in which it was installed.
"""

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

SCRIPT = """
const validator = require("gltf-validator");
const bytes = new Uint8Array(require("fs").readFileSync(process.argv[1]));
validator.validateBytes(bytes).then(report => console.log(JSON.stringify(report)));
"""


def gltf_validator_missing() -> str:
    """Why GLB files cannot be validated here; empty if they can."""
    node = shutil.which("node")
    if node is None:
        return "no Node.js on this machine"
    asked = subprocess.run(
        [node, "-e", 'require("gltf-validator")'], check=False, capture_output=True
    )
    return "" if asked.returncode == 0 else "gltf-validator not found: npm install gltf-validator"


def gltf_report(path: Path) -> dict[str, Any]:
    """The validator's report on a file."""
    node = shutil.which("node")
    assert node is not None
    told = subprocess.run(
        [node, "-e", SCRIPT, str(path)], capture_output=True, check=True, text=True, timeout=60
    )
    report: dict[str, Any] = json.loads(told.stdout)
    return report
