"""Folders of results made by hand, and what stands in the pages that are made of them."""

import base64
import json
import re

import numpy as np

from footfall.pdr.track import Track, write_track
from footfall.scenarios.judge.score import mean_score, score
from footfall.simulate.budget import DriftBudget, write_budget
from footfall.simulate.walk import write_walk
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
