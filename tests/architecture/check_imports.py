"""Fails, and says where, on an include of another module's private header, a public header that includes more than Eigen
and the standard library, a circle between modules or between the folders of a module, and a type whose name another
header gives to another type: the linker would take the one for the other.

    check_imports.py LIBVMESH
"""

import pathlib
import re
import sys
from collections import defaultdict

INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')
NAMESPACE = re.compile(r"namespace\s+([\w:]+)\s*{$")
TYPE = re.compile(r"(?:struct|class)\s+(\w+)[^;]*$")


def includes(path):
    """Line, bracket and name of every include."""
    with open(path, encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            if match := INCLUDE.match(line):
                yield number, match.group(1), match.group(2)


def check_public(root, problems, needs):
    for path in sorted((root / "include").rglob("*.h")):
        module = path.relative_to(root / "include/vmesh").parts[0]
        for line, bracket, name in includes(path):
            parts = name.split("/")
            if bracket == "<":
                if len(parts) > 1 and parts[0] != "Eigen" or name.endswith(".h"):
                    problems.append(f"{path}:{line}: a public header includes <{name}>")
            elif parts[0] != "vmesh":
                problems.append(f"{path}:{line}: a public header includes the private {name}")
            elif parts[1] != module:
                needs[module].add(parts[1])


def check_private(root, problems, needs):
    source = root / "src"
    for path in sorted([*source.rglob("*.h"), *source.rglob("*.cpp")]):
        folder = path.parent.relative_to(source)
        module = folder.parts[0]
        for line, bracket, name in includes(path):
            if bracket == "<":
                continue
            if name.startswith("vmesh/"):
                if (other := name.split("/")[1]) != module:
                    needs[module].add(other)
                continue
            target = next((t for t in (source / name, path.parent / name) if t.exists()), None)
            if target is None:  # made by the build
                continue
            other = target.parent.relative_to(source)
            if other.parts[0] != module:
                problems.append(f"{path}:{line}: includes {name}, which is private to {other.parts[0]}")
            elif other != folder:
                needs[str(folder)].add(str(other))


def check_types(root, problems):
    seen = {}
    for path in sorted(root.rglob("*.h")):
        namespaces = []
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if match := NAMESPACE.match(line):
                namespaces.append(match.group(1))
            elif line.startswith("}  // namespace") and namespaces:
                namespaces.pop()
            elif match := TYPE.match(line):  # at the begin of a line: in no other type
                name = "::".join([*namespaces, match.group(1)])
                if (first := seen.setdefault(name, f"{path}:{number}")) != f"{path}:{number}":
                    problems.append(f"{path}:{number}: {name} is another type in {first}")


def circle_in(needs):
    """The first circle found, as a list that ends where it begins; empty without one."""
    done = set()

    def search(name, way):
        if name in way:
            return way[way.index(name) :] + [name]
        if name in done:
            return []
        for other in sorted(needs.get(name, ())):
            if circle := search(other, way + [name]):
                return circle
        done.add(name)
        return []

    for name in sorted(needs):
        if circle := search(name, []):
            return circle
    return []


def main(root):
    problems, needs = [], defaultdict(set)
    check_public(root, problems, needs)
    check_private(root, problems, needs)
    check_types(root, problems)
    if circle := circle_in(needs):
        problems.append("a circle: " + " -> ".join(circle))
    for problem in problems:
        print(problem, file=sys.stderr)
    print(f"{len(needs)} modules and folders, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
