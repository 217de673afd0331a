"""The exceptions of vmesh."""

from __future__ import annotations

from typing import TYPE_CHECKING, List, Sequence

if TYPE_CHECKING:
    from ._core import Defect, Surface, VolumeDefect, VolumeMesh


class Error(Exception):
    """Base of everything that vmesh raises. The message says what is wrong, where, and what to do."""


class InvalidInput(Error, ValueError):
    """The content of a file or an argument is wrong: not finite, out of range, an unknown node ..."""


class ReadError(Error, OSError):
    """A file cannot be opened or read."""


class WriteError(Error, OSError):
    """A file cannot be written; nothing is left behind under its name."""


class Unsupported(Error):
    """The request is sensible, but this build or this version cannot serve it."""


class Cancelled(Error):
    """The progress callback returned False."""


class DefectiveSurface(Error):
    """No sound surface was found. `surface` is the best that was, `defects` what is wrong with it."""

    def __init__(self, surface: Surface) -> None:
        self.surface = surface
        self.defects: List[Defect] = surface.defects
        super().__init__(_message(self.defects))


class DefectiveVolume(Error):
    """No sound volume mesh was found. `volume` is what was, `defects` what is wrong with it."""

    def __init__(self, volume: VolumeMesh) -> None:
        self.volume = volume
        self.defects: List[VolumeDefect] = volume.defects
        lines = [f"{defect.kind}: {defect.message}" for defect in self.defects]
        lines.append("no sound volume mesh was found: try fewer or thinner layers, or another around")
        super().__init__("\n".join(lines))


class SurfaceWarning(UserWarning):
    """Something about a result that its user should know."""


for _error in (
    Error,
    InvalidInput,
    ReadError,
    WriteError,
    Unsupported,
    Cancelled,
    DefectiveSurface,
    DefectiveVolume,
    SurfaceWarning,
):
    _error.__module__ = "vmesh"  # as users know it


def _message(defects: Sequence[Defect], named: int = 8) -> str:
    lines = [f"{defect.kind}: {defect.message}" for defect in defects[:named]]
    if len(defects) > named:
        lines.append(f"and {len(defects) - named} more defects")
    lines.append(
        "no sound surface was found: check the radii and nodes there, try another around or blend, "
        "or take the surface as it is with allow_defects=True"
    )
    return "\n".join(lines)
