# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmarks: python3 build_tools/dev.py bench [NAME…]. Each writes what it
measured to out/bench/NAME.json, and prints its tables, which are also files under out/bench/tables/."""

import argparse
import json
import os
import platform
import time
from pathlib import Path

import curvature_peaks
import drag
import drawn
import energies
import exactness
import fill_lengths
import fills
import fit
import fit_cages
import jobs
import limits
import machine_parts
import measured_points
import offsets
import pads
import peers
import rims
import side_by_side
import sizes
import step_distances
import subdivision
import table

BENCHMARKS = {
    "peers": peers,
    "sizes": sizes,
    "step_distances": step_distances,
    "side_by_side": side_by_side,
    "subdivision": subdivision,
    "limits": limits,
    "rims": rims,
    "jobs": jobs,
    "drawn": drawn,
    "machine_parts": machine_parts,
    "measured_points": measured_points,
    "peaks": curvature_peaks,
    "pads": pads,
    "offsets": offsets,
    "energies": energies,
    "exact": exactness,
    "fills": fills,
    "fit": fit,
    "fit_cages": fit_cages,
    "fill_lengths": fill_lengths,
    "drag": drag,
}


def circumstances() -> dict:
    """The conditions of the figures, besides the program."""
    cpu = Path("/proc/cpuinfo")
    names = (
        [
            line.split(":")[1].strip()
            for line in cpu.read_text().splitlines()
            if "model name" in line
        ]
        if (cpu.exists())
        else []
    )
    return {
        "processor": names[0] if names else platform.processor(),
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
        "time": time.strftime("%Y-%m-%d %H:%M:%S"),
    }


def main() -> None:
    """Runs the named benchmarks, all by default."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(BENCHMARKS))
    names = parser.parse_args().names or list(BENCHMARKS)
    unknown = [name for name in names if name not in BENCHMARKS]
    if unknown:
        parser.error(f"no such benchmark: {', '.join(unknown)}; there are {', '.join(BENCHMARKS)}.")
    folder = table.OUT / "tables"
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        before = circumstances()
        result = BENCHMARKS[name].run()
        found = {"before": before, "load_after": circumstances()["load"], "result": result}
        (table.OUT / f"{name}.json").write_text(json.dumps(found, indent=1) + "\n")
        for title, text in BENCHMARKS[name].tables(result).items():
            print(f"{title}{text}")
            (folder / f"{title}.md").write_text(text.strip() + "\n")
        print(f"{name}: {before['cores']} cores, load {before['load']} when it began", flush=True)


if __name__ == "__main__":
    main()
