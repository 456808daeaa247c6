"""Runs a check on a tree, for the tests of the checks."""

import subprocess
import sys


def check(tool, root):
    """Returns the exit status and the output lines of a tool for the tree in `root`."""
    result = subprocess.run([sys.executable, str(tool), str(root)], capture_output=True, text=True)
    return result.returncode, result.stdout.splitlines()


def check_file(tool, root, name, text):
    """The same for a tree to which the file `name` is added."""
    path = root / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return check(tool, root)
