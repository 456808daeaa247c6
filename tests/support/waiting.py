"""Waiting for a condition in tests."""

import time


def wait_for(condition, seconds=60):
    """Waits until condition() is true. Raises AssertionError after a time that only a failure takes."""
    for _ in range(10 * seconds):
        if condition():
            return
        time.sleep(0.1)
    raise AssertionError(f"it did not happen within {seconds} s")
