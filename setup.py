"""Puts what lies beside the packages into the wheel: templates, built front end, documents. The rest is in
pyproject.toml."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

BESIDE = ("templates", "static/dist", "docs")  # below gpsr_site/files in a wheel


class BuildWithFiles(build_py):
    def run(self) -> None:
        super().run()
        if self.editable_mode:
            return
        if not Path("static/dist/main.js").is_file():
            sys.exit(
                "static/dist has no front end, and a wheel without it shows no page. "
                "Build it first: make wheel, or python static/build.py and then this again."
            )
        for folder in BESIDE:
            target = Path(self.build_lib, "gpsr_site", "files", folder)
            shutil.rmtree(target, ignore_errors=True)
            shutil.copytree(folder, target, ignore=shutil.ignore_patterns(".*"))


setup(cmdclass={"build_py": BuildWithFiles})
