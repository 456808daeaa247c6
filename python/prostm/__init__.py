"""Ultrasound touch in mid-air: from a pressure on a hand to the paths of a few focal points (PRO-STM).

    import prostm
    result = prostm.plan(pressure, cell_mm=5)          # (rows, cols), NaN = no skin
    for path in result.paths:
        print(path.points, path.pressure, path.length)  # (n, 2) m, (n,), m
    print(result.metrics())

Names are those of the C++ headers and everything is SI (m, s, m/s, Hz); only a name that ends in _mm means
millimetres. Bad values raise ValueError, invalid files InputError (a ValueError), and values of a wrong type TypeError,
each with one sentence that names the problem and the remedy. Arrays of results are read-only; most are views that keep
their data alive. The interpreter's lock is released while planning, scoring, emitting, reading and writing.

  targets              TargetField, TargetFrame, read_field, write_field, field_from_json, field_to_json
  planning             plan, Planner, PlanSettings, PlanResult, PlanStatus, PlanStats, PlanTrace
  the AM baseline      AmPlanner, AmSettings, FocalPoint, FocusEmitter
  plans                Plan, FocalPath, closed_length, read_plan, write_plan, plan_from_json, plan_to_json, PlanFile
  recordings           Recording, GateResult
  shape of a field     field_shape, FieldShape
  quality              quasi_static_field, score_plan, score_field, controls, Metrics, Control
  what is felt         felt_plan, FeltPlan, felt_skins, SkinSettings, sensation_interval, sensation_words
  samples at 40 kHz    emit, Emitter, PathEmitter, EmitSettings, lift, LiftedPlan, LiftedPath, LiftedFocus,
                       drive_intensity, even_share, EmitStats, TakeOver
"""

import math as _math
import numbers as _numbers
import os as _os

from . import _compiled as _compiled
from ._arguments import explain_wrong_types as _explain_wrong_types, wrong_type as _wrong_type

_explain_wrong_types()

from ._prostm import (AmPlanner, AmSettings, Control, EmitSettings, EmitStats, Emitter, FeltPlan, FocalPath, FocalPoint,
                      FieldShape, FocusEmitter, GateResult, InputError, LiftedFocus, LiftedPath, LiftedPlan, Metrics,
                      PathEmitter, Plan, PlanFile, Planner, PlanResult, PlanSettings, PlanStats, PlanStatus, PlanTrace,
                      Recording, SkinSettings, TakeOver, TargetField, TargetFrame, __commit__, __version__, closed_length,
                      controls, drive_intensity, even_share, felt_plan, felt_skins, field_from_json, field_shape, field_to_json,
                      height_at, kMaxFieldCells, kMaxPatches, kMaxPathPoints, kMaxPaths, kMostSamples as _kMostSamples,
                      lift, max_pressure, plan_from_json, plan_to_json, quasi_static_field, read_field, read_plan,
                      score_field, score_plan, sensation_interval, sensation_words, write_field, write_plan)

__all__ = [
    "plan", "Planner", "PlanSettings", "PlanResult", "PlanStatus", "PlanStats", "PlanTrace",
    "AmPlanner", "AmSettings", "FocalPoint", "FocusEmitter",
    "TargetField", "TargetFrame", "read_field", "write_field", "field_from_json", "field_to_json",
    "max_pressure", "height_at",
    "Plan", "FocalPath", "closed_length", "read_plan", "write_plan", "plan_from_json", "plan_to_json", "PlanFile",
    "Recording", "GateResult", "field_shape", "FieldShape",
    "quasi_static_field", "score_plan", "score_field", "controls", "Metrics", "Control",
    "felt_plan", "FeltPlan", "felt_skins", "SkinSettings", "sensation_interval", "sensation_words",
    "emit", "Emitter", "PathEmitter", "EmitSettings", "lift", "LiftedPlan", "LiftedPath", "LiftedFocus",
    "drive_intensity", "even_share",
    "EmitStats", "TakeOver", "InputError", "kMaxFieldCells", "kMaxPatches", "kMaxPathPoints", "kMaxPaths",
]


def _target(field, cell, cell_mm, width_mm, frame, invert):
    """Returns the TargetField or TargetFrame for the field that plan() is given."""
    if isinstance(field, (str, _os.PathLike)):
        if cell is not None:
            raise ValueError("the cell of a file is given in millimetres, as cell_mm")
        return read_field(field, cell_mm=cell_mm, width_mm=width_mm, frame=frame, invert=invert)
    if frame is not None:
        raise ValueError("frame belongs to the name of a recording")
    if width_mm is not None or invert:
        raise ValueError("width_mm and invert belong to the name of a file; an array has cell or cell_mm")
    if not isinstance(field, (TargetField, TargetFrame)):
        return TargetField(field, cell=cell, cell_mm=cell_mm)
    if cell is not None or cell_mm is not None:
        raise ValueError(f"a {type(field).__name__} has its own cell size; leave out cell and cell_mm")
    return field


def plan(field, preset=None, *, method="pro-stm", cell=None, cell_mm=None, width_mm=None, frame=None, invert=False,
         settings=None, trace=False, **more):
    """Plans one field and returns a PlanResult; the plan equals that of `prostm plan` to the bit.

    field: a (rows, cols) array of pressures >= 0 in any unit, NaN = no skin, row 0 at the smallest y; or a
        TargetField, a TargetFrame, or the name of a field's file.
    preset: as on the command line; None: that of the settings.
    method: "pro-stm": paths, or "am": foci that stand still, which takes neither preset nor trace.
    cell, cell_mm: edge of a cell [m] or [mm]; an array needs one of them, a .npy or .png file needs cell_mm or
        width_mm, the width of the whole field [mm].
    frame: frame of a recording (.h5, default 0) or of a 3-D array, counted from 0.
    invert: a .png file is drawn black on white, so that black is the pressure.
    settings: PlanSettings, or AmSettings for "am"; None: the defaults. Further keywords are settings, e.g. paths=2,
        draw_rate=70.
    trace: keep the intermediate results, as PlanResult.trace.

    Every call creates a planner. For many fields create one Planner and call its plan().
    Raises ValueError, TypeError.
    """
    if method not in ("pro-stm", "am"):
        raise ValueError(f"method {method!r} is unknown: it must be pro-stm or am")
    if method == "am" and (preset is not None or trace):
        raise ValueError("preset and trace belong to method pro-stm; am has neither")
    target = _target(field, cell, cell_mm, width_mm, frame, invert)
    if preset is not None:
        more["preset"] = preset
    patches = target.patches if isinstance(target, TargetFrame) else [target]
    cells = max([patch.rows * patch.cols for patch in patches], default=1)
    if method == "am":
        return AmPlanner(settings, cells, **more).plan(target)
    return Planner(settings, cells, **more).plan(target, trace)


def emit(plan, target=None, seconds=1.0, full_scale_pressure=None, *, sample_rate=40e3, settings=None, **more):
    """Returns the samples that a device would get to play one plan for some time, starting from silence.

    plan: a PlanResult; or a Plan with the TargetField or TargetFrame that it was made for as target, whose plane and
        heights lift it.
    seconds: duration; the output does not fade out for lack of a new plan.
    full_scale_pressure: the rendered pressure, in the target's unit, that is played at intensity 1; None: that of the
        settings, else of PlanResult.emission, else the default gain times the target's largest pressure.
    settings: EmitSettings; further keywords are settings. Without settings there are as many focal points as the plan
        has paths or foci.

    Returns (positions, intensities): (t, foci, 3) float32 in the device's frame [m] and (t, foci) float32 in 0..1,
    with t = round(seconds * sample_rate). Intensity 1 is full scale; pressures above it are clipped.
    """
    for name, value in (("seconds", seconds), ("sample_rate", sample_rate)):
        if not isinstance(value, _numbers.Real):
            raise _wrong_type("emit()", name, "a number", value)
    if settings is not None and not isinstance(settings, EmitSettings):
        raise _wrong_type("emit()", "settings", "an EmitSettings or None", settings)
    lifted = lift(plan, target)
    result = plan if isinstance(plan, PlanResult) else None
    if settings is not None:
        own = settings.copy()
    else:
        own = EmitSettings() if result is None else result.emission
        own.foci = max(1, len(lifted.paths), len(lifted.foci))
    if full_scale_pressure is not None:
        own.full_scale_pressure = full_scale_pressure
    elif own.full_scale_pressure == 0:
        own.full_scale_pressure = _full_scale(target) if result is None else result.emission.full_scale_pressure
    own.stall_time = max(own.stall_time, min(2.0 * seconds, 1e6))
    emitter = (FocusEmitter if lifted.foci else PathEmitter)(own, sample_rate, **more)
    samples = round(seconds * sample_rate) if _math.isfinite(seconds) else 0
    if not 1 <= samples <= _kMostSamples:
        raise ValueError(f"emit(): seconds = {seconds} must be between {1 / sample_rate:g} and "
                         f"{_kMostSamples / sample_rate:g}")
    emitter.submit(lifted)
    return emitter.fill(0, samples)


def _full_scale(target):
    """Returns the full scale of a plan that is not a PlanResult: the default gain times the largest pressure."""
    return max(PlanSettings().gain * max_pressure(target), 1e-300)
