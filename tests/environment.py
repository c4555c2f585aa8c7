"""Sets the environment that the tests run in, before Django's settings are read (a ``-p`` plugin)."""

import os
import tempfile

var = tempfile.mkdtemp(prefix="gpsr-tests-")
os.mkdir(os.path.join(var, "static"))  # where collectstatic would write, and whitenoise looks
os.environ["GPSR_VAR_DIR"] = var
os.environ["DEBUG"] = "false"
os.environ.setdefault("OMP_NUM_THREADS", "1")  # tests run beside each other
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")  # so do those that need more threads
os.environ["HOST"] = "127.0.0.1"
os.environ["PARSER_PORT"] = "1"  # nobody answers there
os.environ["GPSR_QUEUE_PREFIX"] = f"{os.path.basename(var)}-"  # processes of tests share a broker
for name in ("GPSR_LLM_URL", "GPSR_LLM_KEY", "GPSR_LLM_REMOTE"):
    os.environ.pop(name, None)  # tests ask no server but those that they start
if url := os.environ.get("TEST_BROKER_URL"):
    os.environ["CELERY_BROKER_URL"] = url
else:
    os.environ.pop("CELERY_BROKER_URL", None)
if url := os.environ.get("TEST_DATABASE_URL"):
    os.environ["DATABASE_URL"] = url
else:
    os.environ.pop("DATABASE_URL", None)
