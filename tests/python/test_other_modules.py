# SPDX-License-Identifier: BSL-1.0
"""Other compiled modules in the process are as they would be without this package."""
import neighbour
import pytest

import nysalt


def test_exceptions_of_others_are_told_by_others():
    with pytest.raises(OverflowError, match="^--too-large was given$"):
        neighbour.overflow()
    with pytest.raises(ValueError, match="^give --force$"):
        neighbour.invalid()
    with pytest.raises(ValueError, match="^threads must be"):  # and here options are told as arguments
        nysalt.run(nysalt.system("fpu"), "verlet", 0.1, 1, threads=0)
