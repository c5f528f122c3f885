#!python
# SPDX-License-Identifier: Apache-2.0

"""The command `cohort` of a wheel: runs the program in the package, with this Python for controllers in Python."""

import importlib.util
import os
import pathlib
import sys

# Finds the package without importing it, which would take longer than the program.
package = pathlib.Path(importlib.util.find_spec("cohort").origin).parent
program = package / "bin" / "cohort"
os.environ.setdefault("COHORT_PYTHON", sys.executable)
os.execv(program, [str(program), *sys.argv[1:]])
