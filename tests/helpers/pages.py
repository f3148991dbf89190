"""Folders of results made by hand, and what stands in the pages that are made of them."""

import base64
import json
import re
from dataclasses import replace

import numpy as np

from footfall.pdr.track import Track, write_track
from footfall.scenarios.judge.score import Score, mean_score, score
from footfall.scenarios.studies.rows import table, write_rows
from footfall.scenarios.trial import Row
from footfall.simulate.budget import DriftBudget, write_budget
from footfall.simulate.walk import write_walk
from footfall.tables import write_table
from tests.helpers.synthetic import synthetic_walk

NASTY = "<img src=x onerror=window.hacked=1>&amp;"  # also a method's name, which is part of a file's
METHODS = ("pdr", "hdr", NASTY)


def run_folder(folder, methods=METHODS, walks=2, strides=40, **more):
    """What `footfall run` leaves: walks that turn by 0.02 and 0.04 rad/s, tracks that drift off."""
    folder.mkdir(exist_ok=True)
    rows, scored = [], {name: [] for name in methods}
    for number in range(1, walks + 1):
        walk = synthetic_walk(strides=strides, turn=0.02 * number)
        write_walk(walk, folder / f"walk-{number}.parquet")
        tracks = {name: track_of(walk, name, number * (i + 1)) for i, name in enumerate(methods)}
        for name, track in tracks.items():
            write_track(track, folder / f"walk-{number}.{name}.parquet")
            scored[name].append(score(track, walk))
        write_budget(budget_of(walk, number), folder / f"walk-{number}.drift.parquet", {})
        seeds = {"seed": 10 + number, "imu": "nimu", "unit": 100 + number, "noise": 200 + number}
        own = {name: scored[name][-1].as_dict() for name in methods}
        rows.append({**seeds, "subject": "reference", "footfalls": len(walk.footfalls.t), "methods": own})
    document = {
        "scenario": "corridor",
        "description": "two corridors",
        "command": "footfall run corridor --methods 'pdr,hdr'",
        "distance_m": 56.0,
        "duration_s": 44.0,
        "settings": {"hdr.tau_s": 4.0},
        "versions": {"footfall": "0.1.0", "numpy": "2.4.6"},
        "walks": rows,
        "mean": {name: mean_score(scores).as_dict() for name, scores in scored.items()},
    }
    (folder / "scores.json").write_text(json.dumps(document | more), encoding="utf-8")
    return folder


def track_of(walk, name, times):
    """An estimate that runs 2 % long and turns away by `times` 0.01 deg/s; of hdr with its evidence."""
    falls = walk.footfalls
    off = np.radians(0.01 * times) * (falls.t - falls.t[0])
    evidence = {"integrator": np.linspace(0, 0.002, len(off)), "attenuator": np.full(len(off), 0.25)}
    return Track(
        t=falls.t,
        position=falls.position * [1.02, 1.0, 1.0] + off[:, None] * [0, 400.0, 0],
        heading=falls.heading + off,
        evidence=evidence if name == "hdr" else {},
        units={"integrator": "rad/s", "attenuator": ""} if name == "hdr" else {},
        meta={"method": name, "params": {"tau_s": 8.0, "inner": {"deep": 1.5}} if name == "hdr" else {}},
    )


def budget_of(walk, times=1):
    """A stride's drift grows with its number, so that each can be told from its neighbours."""
    t = walk.footfalls.t
    count = np.arange(1, len(t))
    causes = {"temperature": 1e-5 * times * count, "white": np.full(len(count), -3e-5), "scale": 1e-9 * count}
    return DriftBudget(t[1:] - walk.t[0], np.diff(t), causes, sum(causes.values()))


class Page:
    """A page as its source tells it: `text` without plotly's script, `charts` with their numbers."""

    def __init__(self, file):
        whole = file.read_text(encoding="utf-8")
        # Ours are an element of data and a last script; plotly's own is the longest of all.
        longest = max(re.findall(r"<script>\n(.*?)\n</script>", whole, re.DOTALL), key=len)
        self.plotly, self.text = len(longest.encode()), whole.replace(longest, "")
        (data,) = re.findall(
            r'<script type="application/json" id="data">(.*?)</script>', self.text, re.DOTALL
        )
        self.data = json.loads(data)
        self.arrays = [np.frombuffer(base64.b64decode(array), "<f4") for array in self.data["arrays"]]

    def charts(self, place, **when):
        return [
            chart
            for chart in self.data["charts"]
            if chart["place"] == place and chart["when"].items() >= when.items()
        ]

    def trace(self, place, name, nth=0, **when):
        """(x, y, hover) of the nth trace of that name in the one chart; hover is label -> values."""
        (chart,) = self.charts(place, **when)
        trace = [trace for trace in chart["traces"] if trace["name"] == name][nth]
        hover = {
            line["label"]: self.arrays[line["values"]]
            + (0 if line["plus"] is None else self.arrays[line["plus"]])
            for line in trace["hover"]
        }
        return self.arrays[trace["x"]], self.arrays[trace["y"]], hover

    def table(self, caption):
        """Rows of the text of cells, heads first, of the table with this in its caption."""
        (found,) = [
            table for table in re.findall(r"<table.*?</table>", self.text, re.DOTALL) if caption in table
        ]
        rows = re.findall(r"<tr>(.*?)</tr>", found, re.DOTALL)
        return [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.DOTALL) for row in rows]


def sweep_folder(
    folder, methods=("pdr", "hdr"), radii=(5, 10, 20), units=10, fail=True, kind="integer", **more
):
    """What `footfall sweep` leaves: an arc's radius, a parameter of hdr alone, two sheets, some failures.

    The mean heading error of hdr is radius x theta x (1 + unit / 10), pdr's ten times the radius; the sheet
    doubles it.
    """
    folder.mkdir(exist_ok=True)
    rows, points = [], []
    for radius in radii:
        for imu, times in (("nimu", 1.0), ("phone", 2.0)):
            for method in methods:
                for theta in (None,) if method == "pdr" else (0.1, 0.25):
                    for unit in range(units):
                        error = times * radius * (10.0 if theta is None else theta * (1 + unit / 10))
                        case = Row("one-arc", 0, 1, "reference", imu, 1000 + unit, 1000 + unit, method)
                        failed = fail and method == "hdr" and unit == 0 and theta == 0.1
                        result = {"score": Score(error, 2 * error, 3, -error, 5, 6), "footfalls": 40}
                        lost = {"stage": "track", "error": "the filter <b>diverged</b>"}
                        rows.append(replace(case, **(lost if failed else result)))
                        points.append({"radius_m": radius, "hdr.theta_w_deg_s": theta})
    made = table(rows, points, {"radius_m": kind, "hdr.theta_w_deg_s": "number"}, "key")
    write_rows(made, folder / "results.parquet")
    axes = {
        "radius_m": {"values": list(radii), "unit": "m", "label": "radius"},
        "imu": {"values": ["phone", "nimu"], "unit": "", "label": "IMU"},
        "hdr.theta_w_deg_s": {"values": [0.1, 0.25], "unit": "deg/s", "label": "theta w"},
    }
    document = {
        "name": "arcs",
        "description": "one arc",
        "command": "footfall sweep arcs.toml",
        "versions": {"numpy": "2.4.6"},
        "scenarios": ["one-arc"],
        "methods": [
            {"name": name, "description": f"what {name} does", "parameters": {"tau_s": 8.0}}
            for name in methods
        ],
        "axes": axes,
        "cases": {"units": units, "walks": None},
        "design": {"kind": "grid"},
        "set": {"scenario.gait.pace_m_s": 1.3},
    }
    (folder / "study.json").write_text(json.dumps(document | more), encoding="utf-8")
    tracks = folder / "tracks"
    tracks.mkdir(exist_ok=True)
    walk = synthetic_walk(strides=20)
    falls = walk.footfalls
    columns = {"t": falls.t, "heading": falls.heading, **dict(zip("xyz", falls.position.T, strict=True))}
    write_table(tracks / "walk-1.footfalls.parquet", columns, {}, {})
    index = []
    for i, which in enumerate(("best", "worst")):
        write_track(track_of(walk, "hdr", 1 + i), tracks / f"hdr-{which}.parquet")
        entry = {"file": f"hdr-{which}.parquet", "truth": "walk-1.footfalls.parquet", "method": "hdr"}
        entry |= {"scenario": "one-arc", "walk_seed": 1, "unit_seed": 1001 + i, "imu": "nimu", "which": which}
        index.append(
            entry | {"axes": {"radius_m": 5, "hdr.theta_w_deg_s": 0.25}, "heading_error_mean_deg": i}
        )
    (tracks / "index.json").write_text(json.dumps(index), encoding="utf-8")
    return folder


def gate_folder(folder, units=20, fail=0, **more):
    """What `footfall gate` leaves. Unit k errs by k deg with hdr, by 4 k with pdr; the last ones failed."""
    folder.mkdir(exist_ok=True)
    rows = []
    for unit in range(1, units + 1):
        for method, error in (("hdr", unit), ("pdr", 4 * unit)):
            case = Row("closed-loop", 0, 1, "reference", "nimu", 1000 + unit, 1000 + unit, method)
            failed = method == "hdr" and unit > units - fail
            result = {"score": Score(error, error, 1, -1, 1, 1)}
            rows.append(replace(case, **({"stage": "track", "error": "lost"} if failed else result)))
    write_rows(table(rows), folder / "cases.parquet")
    metric, gates = "heading_error_mean_deg", []
    for name, against, unit, statistic, estimate, low, high, limit, verdict, reason in (
        ("half below 15", None, "deg", "median", 10.5, 6.0, None, 15.0, "undecided", "20 cases cannot tell"),
        ("a third of pdr", "pdr", "%", "median", -75.0, -80.0, -70.0, -66.0, "pass", ""),
        ("most below 18", None, "%", "share_below", 85.0, 65.0, 95.0, 90.0, "fail", ""),
        ("as released", "old.parquet", "%", "median", 1.0, 0.5, 2.0, 10.0, "pass", ""),
        ("nothing moved", "pdr", "cases", "same", 3.0, None, None, 0.1, "fail", "3 of 20 cases moved"),
    ):
        gate = {"name": name, "method": "hdr", "against": against, "metric": metric, "unit": unit}
        gate |= {"statistic": statistic, "estimate": estimate, "low": low, "high": high, "limit": limit}
        gate |= {"verdict": verdict, "reason": reason, "needed": None, "scatter": None}
        gates.append(gate | {"cases": units, "left_out": 0})
    document = {
        "name": "gates",
        "description": "nothing gets worse",
        "command": "footfall gate gates.toml",
        "versions": {"numpy": "2.4.6"},
        "cases": {
            "scenario": "closed-loop",
            "walks": 5,
            "units": units,
            "imu": "nimu",
            "seeds": {"walks": 1, "units": 1000},
        },
        "confidence": 0.95,
        "gates": gates,
        "exit_code": 1,
    }
    (folder / "gate.json").write_text(json.dumps(document | more), encoding="utf-8")
    return folder
