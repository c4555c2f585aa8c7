#!/usr/bin/env python
"""Django's command line for GPSR Workbench, in a checkout: ``gpsr-workbench manage``."""

import sys

from gpsr_site.__main__ import manage

if __name__ == "__main__":
    manage(sys.argv[1:])
