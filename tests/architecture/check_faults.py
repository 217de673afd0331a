"""Makes a library with a fault and checks that check_imports.py finds it."""

import pathlib
import subprocess
import sys
import tempfile

FAULTS = {
    "private_header": ({"src/b/b.cpp": '#include "a/inner.h"\n'}, "private to a"),
    "circle": ({"src/b/x/x.h": '#include "b/y/y.h"\n', "src/b/y/y.h": '#include "b/x/x.h"\n'}, "b/x -> b/y -> b/x"),
    "two_types": ({"src/b/b.h": "struct Place {\n", "src/a/a.h": "class Place : Point {\n"}, "Place is another type"),
    "third_party": ({"include/vmesh/a/a.h": "#include <tbb/parallel_for.h>\n"}, "tbb/parallel_for.h"),
}
SOUND = {
    "include/vmesh/a/a.h": "#pragma once\n#include <vector>\n#include <Eigen/Core>\n",
    "src/a/inner.h": '#pragma once\n#include "vmesh/a/a.h"\n',
    "include/vmesh/b/b.h": '#pragma once\n#include "vmesh/a/a.h"\n',
}


def result_for(check, files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return subprocess.run([sys.executable, check, folder], capture_output=True, text=True)


def main(check, fault):
    files, message = FAULTS[fault]
    sound, faulty = result_for(check, SOUND), result_for(check, SOUND | files)
    if sound.returncode != 0 or faulty.returncode != 1 or message not in faulty.stderr:
        print(sound.stderr, faulty.stderr, f"expected: {message}", sep="\n", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
