"""`python -m vmesh`, and the command `vmesh` of a wheel: the program that lies in the package takes over."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def main() -> None:
    program = Path(__file__).parent / "bin" / "vmesh"
    if not program.exists():
        sys.exit("vmesh: this package has no command; it is in the package vmesh of Debian and in the wheel")
    os.execv(program, [str(program), *sys.argv[1:]])


if __name__ == "__main__":
    main()
