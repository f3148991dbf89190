"""A unit on a walk whose drift is a sum over causes: other sheets in no time.

The drift budget tells what each effect of the sensor adds to a stride's raw rate. The same unit of a sheet
with twice an effect's sigma adds twice as much: its draws are the same, scaled. So the raw rate of any such
sheet is each cause by its factor and what no cause says (the truth, dead reckoning's own errors, effects that
do not scale); HDR then runs compiled. What is not linear is left out (low-pass, rounding, clipping, what a
noisy sensor does to stances and tilt), so it is to be checked against the full chain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from footfall.errors import InputError
from footfall.hdr.hdr import NOTHING, HdrParams, HdrSets, heading_errors
from footfall.hdr.method import Method
from footfall.hdr.methods import METHODS
from footfall.models.imu import ImuSpec
from footfall.models.imu.spec import GYRO_KEYS
from footfall.pdr.track import Track
from footfall.scenarios.judge.score import compare
from footfall.scenarios.trial import Trial, perform
from footfall.simulate.budget import DriftBudget
from footfall.simulate.walk import Walk

# Key of the gyro's sheet -> the cause that is proportional to it.
CAUSE_OF = {
    "angle_random_walk_deg_rt_h": "white",
    "flicker_deg_h": "flicker",
    "rate_random_walk_deg_h_rt_h": "rate_random_walk",
    "turn_on_sigma_deg_s": "turn_on",
    "scale_sigma": "scale",
    "misalignment_sigma_deg": "misalignment",
    "non_linearity_sigma_percent_fs": "non_linearity",
    "g_sensitivity_sigma_deg_s_g": "g_sensitivity",
    "g2_sigma_deg_s_g2": "g2",
    "temperature_sigma_deg_s_k": "temperature",
    "temperature2_sigma_deg_s_k2": "temperature",
}
_TOGETHER = ("temperature_sigma_deg_s_k", "temperature2_sigma_deg_s_k2")
METRICS = ("heading_error_mean_deg", "heading_error_final_deg")  # in the order of the compiled errors
_GYRO = "imu.gyro."


@dataclass(frozen=True)
class Case:
    """A trial as its footfalls tell it: the raw rate and what each cause adds to it.

    Attributes
    ----------
    interval, rate : (n,) s and rad/s, of `Footfalls`; row 0 is the start
    true : (n,) rad, the true heading at each footfall, continuous
    start : rad, dead reckoning's first heading
    causes : effect -> (n,) rad/s
    """

    interval: np.ndarray
    rate: np.ndarray
    true: np.ndarray
    start: float
    causes: Mapping[str, np.ndarray]

    def errors_deg(self, sets: HdrSets, scales: Mapping[str, np.ndarray] | None = None) -> np.ndarray:
        """Heading errors (s, 2) of HDR in the order of `METRICS`.

        Parameters
        ----------
        sets : s parameter sets
        scales : effect -> (s,) factor of its errors; the others stay as they are
        """
        scales = scales or {}
        causes = np.array([self.causes[name] for name in scales]).reshape(len(scales), len(self.rate))
        weights = np.array(list(scales.values()), dtype=float).reshape(len(scales), len(sets.tau_s))
        rest = self.rate - causes.sum(axis=0)
        return np.degrees(heading_errors(rest, self.interval, self.true, self.start, sets, causes, weights))


def case_of(trial: Trial, walk: Walk) -> Case:
    """A trial dead-reckoned, with its drift budget.

    Raises
    ------
    InputError
        What a recording, dead reckoning or the score refuses.
    """
    alone = replace(trial.setup, methods=(METHODS["pdr"],))
    outcome = perform(replace(trial, setup=alone), walk, keep=True)
    outcome.rows[0].require()
    assert outcome.kept is not None
    return linear(outcome.kept.tracks["pdr"], walk, outcome.kept.budget)


def linear(track: Track, walk: Walk, budget: DriftBudget) -> Case:
    """A case of dead reckoning's track and the budget of its recording."""
    interval = np.diff(track.t, prepend=track.t[0])

    def rate_of(heading: np.ndarray) -> np.ndarray:
        rate = np.zeros(len(heading))
        rate[1:] = np.diff(heading) / interval[1:]
        return rate

    # What a cause turned by a footfall that was found, which need not be one of the true ones.
    edges = np.concatenate([[budget.t[0] - budget.interval[0]], budget.t])

    def turned(drift: np.ndarray) -> np.ndarray:
        return np.interp(track.t, edges, np.concatenate([[0.0], np.cumsum(drift * budget.interval)]))

    return Case(
        interval=interval,
        rate=rate_of(track.heading),
        true=track.heading - compare(track, walk).heading_error,
        start=float(track.heading[0]),
        causes={name: rate_of(turned(drift)) for name, drift in budget.causes.items()},
    )


def hdr_params(method: Method) -> HdrParams | None:
    """The parameters of a method that is HDR; dead reckoning's are `NOTHING`; None for any other method."""
    if method.run is METHODS["pdr"].run:
        return NOTHING
    return method.params if method.run is METHODS["hdr"].run else None


class Surrogate:
    """Errors of one method over cases, by the values of addresses.

    Parameters
    ----------
    cases : of one sheet, the same as `spec`
    spec : their data sheet
    method : `pdr`, `hdr` or `hdr-basic`, by whatever name
    addresses : what is varied: spreads of the sheet's gyro, and the method's parameters
    metric : of `METRICS`

    Raises
    ------
    InputError
        A method, address or metric that the budget cannot follow, and why.
    """

    def __init__(
        self, cases: Sequence[Case], spec: ImuSpec, method: Method, addresses: Sequence[str], metric: str
    ) -> None:
        params = hdr_params(method)
        if params is None:
            raise InputError(
                f'method {method.name!r}: the budget knows pdr, hdr and hdr-basic; use fidelity = "full"'
            )
        if metric not in METRICS:
            raise InputError(f'metric {metric!r}: the budget knows {" and ".join(METRICS)}; use "full"')
        self.cases, self.addresses, self._method, self._params = cases, tuple(addresses), method, params
        self._column = METRICS.index(metric)
        self._sheet: dict[str, tuple[str, float]] = {}
        for address in addresses:
            if not address.startswith(f"{method.name}."):
                self._sheet[address] = scaled_cause(address, spec)
        effects = [cause for cause, _ in self._sheet.values()]
        twice = next((one for one in effects if effects.count(one) > 1), None)
        if twice is not None:
            raise InputError(f'two parameters scale the cause {twice!r}; use fidelity = "full"')

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Errors (p, cases) in deg at points (p, addresses)."""
        columns = dict(zip(self.addresses, points.T, strict=True))
        own = dict(zip(("tau_s", "i_c", "theta_w"), HdrSets.of([self._params] * len(points)), strict=True))
        for address, values in columns.items():
            if address not in self._sheet:
                name = address.removeprefix(f"{self._method.name}.")
                inside = name.removesuffix("_deg_s")
                own[inside] = values if inside == name else np.radians(values)
        scales = {cause: columns[address] / now for address, (cause, now) in self._sheet.items()}
        sets = HdrSets(**own)
        return np.stack([case.errors_deg(sets, scales)[:, self._column] for case in self.cases], axis=1)


def scaled_cause(address: str, spec: ImuSpec) -> tuple[str, float]:
    """The cause that is proportional to a value of the sheet, and that value.

    Raises
    ------
    InputError
        No cause is; or the sheet has nothing of it that could be scaled.
    """
    key = address.removeprefix(_GYRO)
    if not address.startswith(_GYRO) or key not in CAUSE_OF:
        raise InputError(
            'the drift budget is not proportional to it: use fidelity = "full" (it scales '
            f"{', '.join(_GYRO + one for one in CAUSE_OF)})",
            address,
        )
    now = _value(spec, key)
    if now == 0:
        raise InputError(f'{spec.name} has none of it, nothing to scale: use fidelity = "full"', address)
    if key in _TOGETHER and all(_value(spec, one) for one in _TOGETHER):
        raise InputError(
            'the budget books the linear and the quadratic error together: use fidelity = "full"', address
        )
    return CAUSE_OF[key], now


def _value(spec: ImuSpec, key: str) -> float:
    attribute, unit = GYRO_KEYS[key]
    return float(getattr(spec.gyro, attribute)) / unit
