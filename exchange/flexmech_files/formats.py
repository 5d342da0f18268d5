"""Which format a file has."""

from . import linkage2, linkage_sim, pmks_address, pmks_text, pylinkage
from .errors import FileError

FORMATS = (linkage2, pmks_address, pmks_text, linkage_sim, pylinkage)


def read(text, name):
    """The Drawing of a file, by what is in it."""
    for module in FORMATS:
        if module.is_one(text):
            return module.read(text, name)
    raise FileError("expected a file of Linkage (<linkage2>), PMKS (joints, a line each, or .pmks), pylinkage or linkage_sim (JSON), "
                    "or an address of PMKS+", 1, 1)
