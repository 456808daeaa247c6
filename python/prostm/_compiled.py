"""Imports the compiled module, or raises ImportError with a sentence why this interpreter cannot load it."""

import sys
from pathlib import Path

try:
    from . import _prostm
except ImportError as error:
    folder = Path(__file__).resolve().parent
    built = sorted(file.name for file in folder.glob("_prostm.*") if file.suffix in (".so", ".pyd"))
    here = f"Python {sys.version_info.major}.{sys.version_info.minor} ({sys.executable})"
    if not built:
        sentence = (f"prostm in {folder} has not been built: run ./run python in prostm's own folder, "
                    "and import prostm with /usr/bin/python3")
    elif getattr(error, "name", "") and str(error).startswith(("No module", "cannot import name")):
        sentence = f"prostm in {folder} was built for another interpreter ({built[0]}), and this is {here}"
    else:
        sentence = f"prostm in {folder} cannot be loaded by {here}: {error}"
    raise ImportError(sentence, name="prostm") from error
