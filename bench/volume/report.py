"""Results of bench_volumes.py as Markdown tables, in the style of bench/README.md."""

from __future__ import annotations

from collections.abc import Callable

from tables import DASH, cpu, number, table

NAMES = {"vmesh": "`vmesh volume --layers 0`", "vmesh-layers": "`vmesh volume`", "gmsh-delaunay": "Gmsh, Delaunay",
         "gmsh-hxt": "Gmsh, HXT", "gmsh-core": "Gmsh on our core's boundary", "tetgen": "TetGen alone",
         "ftetwild": "fTetWild", "vmtk": "VMTK", "vmtk-layers": "VMTK with layers"}
# With which of ours a program is compared.
LAYERED = {mesher: "vmesh-layers" for mesher in ("vmesh-layers", "gmsh-core", "vmtk-layers")}
KEPT = 1e-9  # volumes and areas that differ by less are the surface's


def off(value: float) -> str:
    percent = 100 * value
    return "0" if value < KEPT else f"{percent:.0f} %" if percent >= 9.95 else f"{number(float(f'{percent:.2g}'))} %"


def least_to_most(ratios: list[float]) -> str:
    """Two digits that count, of the first and the last."""
    if not ratios:
        return DASH
    least, most = (cpu(ratio) for ratio in (ratios[0], ratios[-1]))
    return least if least == most else f"{least} to {most}"


def seconds(value: float | None) -> str:
    return DASH if value is None else number(value, 3) if value < .095 else cpu(value)


def line(result: dict) -> str:
    """For the log."""
    return (f"{result['tetrahedra']} tetrahedra, {result['wedges']} wedges, {result['inverted']} inverted, least angle "
            f"{result.get('least_angle_deg', 0):.1f}, {result['cpu_seconds']:.3f} s of CPU")


def is_made(result: dict) -> bool:
    return "refused" not in result


def detail(results: dict, meshers: list[str]) -> list[str]:
    """A row for each mesh."""
    header = ["surface, faces", "by", "tetrahedra", "wedges", "inverted", "angle least / mean",
              "radius ratio least / mean", "least Jacobian", "volume off", "caps off", "CPU, s", "wall, s",
              "whole process, CPU s"]
    rows = []
    for name, surface in results.items():
        label = f"{name}, {surface['faces']:,}"
        for mesher in meshers:
            result = surface["meshes"].get(mesher)
            if result is None:
                continue
            row, label = [label, NAMES[mesher]], ""  # a surface's name stands in its first row only
            if not is_made(result):
                rows.append(row + [result["refused"].replace("|", "/")] + [DASH] * (len(header) - 3))
                continue
            rows.append(row + [
                f"{result['tetrahedra']:,}", f"{result['wedges']:,}", str(result["inverted"]),
                f"{result['least_angle_deg']:.1f} / {result['mean_angle_deg']:.1f}",
                f"{number(result['least_radius_ratio'])} / {number(result['mean_radius_ratio'])}",
                number(result["least_scaled_jacobian"]), off(result["volume_off"]), off(result["caps_off"]),
                seconds(result["cpu_seconds"]), seconds(result["wall_seconds"]), seconds(result["whole_cpu_seconds"])])
    return table(header, rows, left=2)


def in_all(results: dict, meshers: list[str]) -> list[str]:
    """A row for each program: over all surfaces."""
    header = ["by", "meshes", "with inverted cells", "least angle: worst / median", "mean angle",
              "least radius ratio: worst / median", "least Jacobian", "volume off, at most", "caps off, at most",
              "times the CPU of ours"]
    rows = []
    for mesher in meshers:
        tried = {name: surface["meshes"][mesher] for name, surface in results.items() if mesher in surface["meshes"]}
        made = [(name, result) for name, result in tried.items() if is_made(result)]
        if not made:
            rows.append([NAMES[mesher], f"0 of {len(tried)}"] + [DASH] * (len(header) - 2))
            continue
        every = [result for _, result in made]

        def values(key: str) -> list[float]:
            return sorted(result[key] for result in every)

        def worst_and_median(key: str, digits: int) -> str:
            return f"{number(values(key)[0], digits)} / {number(values(key)[len(every) // 2], digits)}"

        ours = LAYERED.get(mesher, "vmesh")
        ratios = sorted(result["cpu_seconds"] / results[name]["meshes"][ours]["cpu_seconds"] for name, result in made
                        if mesher != ours and is_made(results[name]["meshes"].get(ours, {"refused": ""})))
        rows.append([
            NAMES[mesher], f"{len(made)} of {len(tried)}", str(sum(result["inverted"] > 0 for result in every)),
            worst_and_median("least_angle_deg", 1),
            number(sum(values("mean_angle_deg")) / len(every), 1), worst_and_median("least_radius_ratio", 3),
            number(values("least_scaled_jacobian")[0]), off(values("volume_off")[-1]), off(values("caps_off")[-1]),
            least_to_most(ratios)])
    return table(header, rows)


def times(results: dict, meshers: list[str]) -> list[str]:
    """CPU seconds and the least angle of each mesh, a surface a row."""
    return each(results, meshers, lambda made: f"{seconds(made['cpu_seconds'])}, {made['least_angle_deg']:.1f}")


def radius_ratios(results: dict, meshers: list[str]) -> list[str]:
    """The least of each mesh, a surface a row."""
    return each(results, meshers, lambda made: number(made["least_radius_ratio"]))


def each(results: dict, meshers: list[str], cell: Callable[[dict], str]) -> list[str]:
    rows = []
    for name, surface in results.items():
        row = [f"{name}, {surface['faces']:,}"]
        for mesher in meshers:
            result = surface["meshes"].get(mesher, {"refused": ""})
            row.append(cell(result) if is_made(result) else DASH)
        rows.append(row)
    return table(["surface, faces", *(NAMES[mesher] for mesher in meshers)], rows)


def versions(results: dict) -> str:
    found = {}
    for surface in results.values():
        for result in surface["meshes"].values():
            found |= result.get("versions", {})
    return ", ".join(f"{package} {number}" for package, number in sorted(found.items()))


def markdown(results: dict, meshers: list[str]) -> str:
    return "\n".join(["Over all surfaces:", "", *in_all(results, meshers), "", "CPU seconds of meshing, least angle:",
                      "", *times(results, meshers), "", "Least radius ratio of tetrahedra:", "",
                      *radius_ratios(results, meshers), "", *detail(results, meshers), "", versions(results)])
