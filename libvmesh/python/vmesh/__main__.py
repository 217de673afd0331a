"""`python -m vmesh`, and the command `vmesh` of a wheel: the program that lies in the package takes over."""

from __future__ import annotations

import os
import sys


def main() -> None:
    program = os.path.join(os.path.dirname(__file__), "bin", "vmesh")
    if not os.path.exists(program):
        sys.exit("vmesh: this package has no command; it is in the package vmesh of Debian and in the wheel")
    os.execv(program, [program, *sys.argv[1:]])


if __name__ == "__main__":
    main()
