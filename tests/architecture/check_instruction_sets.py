"""check_instruction_sets.py NM NAMESPACE OBJECT...: what the linker sees of sources compiled for an instruction set lies
in its namespace. A function of another name, of the standard library say, could replace the one that the whole program
uses, also on machines without these instructions."""
import subprocess
import sys


def strangers(nm, namespace, path):
    """Symbols of an object file that another file's could be exchanged for."""
    listed = subprocess.run([nm, "-C", "--defined-only", path], capture_output=True, text=True, check=True).stdout
    symbols = [line.split(maxsplit=2)[1:] for line in listed.splitlines() if line.strip()]
    return [name for kind, name in symbols if not kind.islower() or kind in "uvw" if namespace not in name]


def main(nm, namespace, *paths):
    if not paths:
        sys.exit("no object files to look at")
    found = {path: strangers(nm, namespace, path) for path in paths}
    for path, names in found.items():
        for name in names:
            print(f"{path}: {name} is outside {namespace}")
    return 1 if any(found.values()) else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
