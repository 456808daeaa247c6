"""Ultrasound touch in mid-air: from a pressure on a hand to the paths of a few focal points (PRO-STM).

    import prostm
    result = prostm.plan(pressure, cell_mm=5)          # (rows, cols), NaN = no skin
    for path in result.paths:
        print(path.points, path.pressure, path.length)  # (n, 2) m, (n,), m
    print(result.metrics())

Names are those of the C++ headers and everything is SI (m, s, m/s, Hz); only a name that ends in _mm means
millimetres. Bad values raise ValueError and files that are wrong InputError, a ValueError, with one sentence that says
what would be right; values of a wrong type raise TypeError. Arrays of results are read-only views that keep alive what
they show. The interpreter's lock is released while planning, scoring, emitting, reading and writing.

  what is to be felt   TargetField, TargetFrame, read_field, write_field, field_from_json, field_to_json
  planning             plan, Planner, PlanSettings, PlanResult, PlanStatus, PlanStats, PlanTrace
  the AM baseline      AmPlanner, AmSettings, FocalPoint, FocusEmitter
  plans                Plan, FocalPath, closed_length, read_plan, write_plan, plan_from_json, plan_to_json, PlanFile
  quality              quasi_static_field, score_plan, score_field, controls, Metrics, Control
  samples at 40 kHz    emit, Emitter, PathEmitter, EmitSettings, lift, LiftedPlan, LiftedPath, LiftedFocus, drive_intensity, even_share, EmitStats,
                       TakeOver
"""

import os as _os

from . import _prostm
from ._prostm import (AmPlanner, AmSettings, Control, EmitSettings, EmitStats, Emitter, FocalPath, FocalPoint,
                      FocusEmitter, InputError, LiftedFocus, LiftedPath, LiftedPlan, Metrics,
                      PathEmitter, Plan, PlanFile, Planner, PlanResult, PlanSettings, PlanStats, PlanStatus, PlanTrace,
                      TakeOver, TargetField, TargetFrame, __version__, closed_length, controls, drive_intensity, even_share,
                      field_from_json, field_to_json, height_at, kMaxFieldCells, kMaxPatches, kMaxPathPoints,
                      kMaxPaths, lift, max_pressure, plan_from_json, plan_to_json, quasi_static_field, read_field,
                      read_plan, score_field, score_plan, write_field, write_plan)

__all__ = [
    "plan", "Planner", "PlanSettings", "PlanResult", "PlanStatus", "PlanStats", "PlanTrace",
    "AmPlanner", "AmSettings", "FocalPoint", "FocusEmitter",
    "TargetField", "TargetFrame", "read_field", "write_field", "field_from_json", "field_to_json",
    "max_pressure", "height_at",
    "Plan", "FocalPath", "closed_length", "read_plan", "write_plan", "plan_from_json", "plan_to_json", "PlanFile",
    "quasi_static_field", "score_plan", "score_field", "controls", "Metrics", "Control",
    "emit", "Emitter", "PathEmitter", "EmitSettings", "lift", "LiftedPlan", "LiftedPath", "LiftedFocus", "drive_intensity", "even_share",
    "EmitStats", "TakeOver", "InputError", "kMaxFieldCells", "kMaxPatches", "kMaxPathPoints", "kMaxPaths",
]


def _target(field, cell, cell_mm):
    """The TargetField of whatever plan() takes."""
    if isinstance(field, (TargetField, TargetFrame)):
        if cell is not None or cell_mm is not None:
            raise ValueError(f"a {type(field).__name__} says itself how large a cell is; leave out cell and cell_mm")
        return field
    if isinstance(field, (str, _os.PathLike)):
        if cell is not None:
            raise ValueError("the cell of a file is given in millimetres, as cell_mm")
        return read_field(field, cell_mm=cell_mm)
    return TargetField(field, cell=cell, cell_mm=cell_mm)


def plan(field, preset=None, *, method="pro-stm", cell=None, cell_mm=None, settings=None, trace=False, **more):
    """Plans one field as `prostm plan` does, with the same plan to the bit, and returns a PlanResult.

    field: a (rows, cols) array of pressures >= 0 in any unit, NaN = no skin, row 0 at the smallest y; or a
        TargetField, a TargetFrame, or the name of a field's file.
    preset: as on the command line; None: that of the settings.
    method: "pro-stm": paths, or "am": foci that stand still; that has neither preset nor trace.
    cell, cell_mm: edge of a cell [m] or [mm]; an array needs one of them, a .npy or .png file needs cell_mm.
    settings: PlanSettings, or AmSettings for "am"; None: the defaults. Further keywords are settings, e.g. paths=2, draw_rate=70.
    trace: keep the intermediate results, as PlanResult.trace.

    Every call makes a planner. For many fields make a Planner once and call its plan().
    Raises ValueError, TypeError.
    """
    if method not in ("pro-stm", "am"):
        raise ValueError(f"method {method!r} is unknown: it must be pro-stm or am")
    if method == "am" and (preset is not None or trace):
        raise ValueError("preset and trace belong to method pro-stm; am has neither")
    target = _target(field, cell, cell_mm)
    if preset is not None:
        more["preset"] = preset
    patches = target.patches if isinstance(target, TargetFrame) else [target]
    cells = max([patch.rows * patch.cols for patch in patches], default=1)
    if method == "am":
        return AmPlanner(settings, cells, **more).plan(target)
    return Planner(settings, cells, **more).plan(target, trace)


def emit(plan, target, seconds, full_scale_pressure, *, sample_rate=40e3, settings=None, **more):
    """The samples that a device would be given to play one plan for some time, starting in silence.

    plan: a Plan. target: the TargetField or TargetFrame that it was made for, whose plane and heights lift it.
    seconds: how long; the plan does not stall. full_scale_pressure: the rendered pressure, in the target's unit, that
    is played at intensity 1. settings: EmitSettings; further keywords are settings. Without foci there are as many
    focal points as the plan has paths or foci.

    Returns (positions, intensities): (t, foci, 3) float32 in the device's frame [m] and (t, foci) float32 in 0..1,
    with t = round(seconds * sample_rate).
    """
    own = EmitSettings() if settings is None else settings.copy()
    if settings is None:
        own.foci = max(1, len(plan))
    own.full_scale_pressure = full_scale_pressure
    own.stall_time = max(own.stall_time, min(2.0 * seconds, 1e6))
    emitter = (FocusEmitter if plan.foci else PathEmitter)(own, sample_rate, **more)
    emitter.submit(lift(plan, target))
    return emitter.fill(0, round(seconds * sample_rate))
