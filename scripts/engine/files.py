"""Files that appear complete or not at all, and their contents."""

import hashlib
import json
import os
from pathlib import Path

# Formats whose file has others beside it: all of the same name but for the last suffixes count.
IN_SEVERAL_FILES = (".csv", ".mhd", ".nhdr", ".hdr")


class PlanError(Exception):
    """What the user has to put right; the message says where."""


def read_json(path):
    """None where there is no such file, or if it is not JSON."""
    try:
        return json.loads(Path(path).read_text())
    except (FileNotFoundError, ValueError):
        return None


def write_text(path, text):
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.uname().nodename}.{os.getpid()}")
    try:
        with open(temporary, "w", encoding="utf-8", newline="") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def write_json(path, content):
    write_text(path, json.dumps(content, indent=1) + "\n")


def write_changed(path, content):
    """A file with the same content keeps its time."""
    if read_json(path) != content:
        write_json(path, content)


def content_key(*content):
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def hash_of(path):
    """SHA-256 of a file's content."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()


def files_of(path):
    """The files that one input consists of."""
    if path.is_dir():
        return sorted(file for file in path.rglob("*") if file.is_file())
    if path.suffix.lower() not in IN_SEVERAL_FILES:
        return [path]
    stem = path.name.split(".")[0]
    return sorted(file for file in path.parent.iterdir() if file.is_file() and file.name.split(".")[0] == stem)


class Hashes:
    """SHA-256 of files, kept in a file; only what has changed since, by size, times and inode, is read again."""

    def __init__(self, path):
        self.path = path
        self.before = read_json(path) or {}
        self.now = {}

    def of_file(self, path):
        stat = path.stat()
        mark = [stat.st_size, stat.st_mtime_ns, stat.st_ctime_ns, stat.st_ino]
        known = self.before.get(str(path))
        if known and known[:4] == mark:
            digest = known[4]
        else:
            digest = hash_of(path)
        self.now[str(path)] = [*mark, digest]
        return digest

    def of_input(self, path):
        """For an unreadable file it is the reason, which vmesh will report as well."""
        try:
            return self.of_readable(path)
        except OSError as error:
            return error.strerror

    def of_readable(self, path):
        files = files_of(path)
        if files == [path]:
            return self.of_file(path)
        whole = hashlib.sha256()
        for file in files:
            whole.update(f"{os.path.relpath(file, path.parent)} {self.of_file(file)}\n".encode())
        return whole.hexdigest()

    def save(self):
        if self.now != self.before:
            write_json(self.path, self.now)
