"""Which browser the tests drive."""

from __future__ import annotations

import os
import shutil

# Debian's two builds. The shell draws no window of its own, which saves a quarter of the processor time.
BUILDS = ("chromium-headless-shell", "chromium")

CHROMIUM = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, BUILDS)), None)

MISSING = f"needs Chromium: install {' or '.join(BUILDS)}, or name one in CHROMIUM"

# ``pytest --browser firefox`` drives Debian's, by WebDriver BiDi.
FIREFOX = os.environ.get("FIREFOX") or shutil.which("firefox-esr") or shutil.which("firefox")
FIREFOX_MISSING = "needs Firefox: install firefox-esr, or name one in FIREFOX"
