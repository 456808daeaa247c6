"""A value of a wrong type produces one sentence: where, what, and what would be right."""

import inspect
import re

import prostm
import pytest


def sentence_of(call):
    with pytest.raises(TypeError) as refused:
        call()
    text = str(refused.value)
    assert "\n" not in text and "incompatible" not in text and "Invoked with" not in text
    return text


@pytest.fixture
def plan(field):
    return prostm.plan(field, "fast").plan


def test_the_sentence_names_the_argument_and_what_would_be_right(field, plan, tmp_path):
    planner, emitter = prostm.Planner(), prostm.PathEmitter(full_scale_pressure=1.0)
    result = planner.plan(field)
    path = result.paths[0]
    for words, call in [
        ("emit(): seconds must be a number, not 'long'", lambda: prostm.emit(result, seconds="long")),
        ("plan must be a Plan or a PlanResult, not 3", lambda: prostm.emit(3, field)),
        ("a Plan needs the TargetField or TargetFrame that it was made for, as target",
         lambda: prostm.emit(plan, seconds=1)),
        ("a PlanResult brings its own", lambda: prostm.lift(plan)),
        ("emit(): settings must be an EmitSettings or None, not a dict", lambda: prostm.emit(result, settings={})),
        ("plan must be a Plan or a PlanResult, not a TargetField", lambda: prostm.lift(field, plan)),
        ("score_plan(): plan must be a Plan, not a PlanResult; give its .plan",
         lambda: prostm.score_plan(field, result)),
        ("score_plan(): target must be a TargetField, not a Plan", lambda: prostm.score_plan(plan, field)),
        ("score_plan(): target must be a TargetField, not None", lambda: prostm.score_plan(None, plan)),
        ("score_plan(): sigma must be a number, not '8 mm'", lambda: prostm.score_plan(field, plan, sigma="8 mm")),
        ("score_plan(): missing a required argument: 'plan'", lambda: prostm.score_plan(field)),
        ("controls(): got an unexpected keyword argument 'sgima'", lambda: prostm.controls(field, sgima=1)),
        ("controls(): seed must be a whole number, not 1.5", lambda: prostm.controls(field, seed=1.5)),
        ("TargetField(): cell must be a number or None, not '5'", lambda: prostm.TargetField([[1.0]], "5")),
        ("TargetField(): too many positional arguments", lambda: prostm.TargetField([[1.0]], 1.0, 2.0)),
        ("FocalPath(): speed must be a number, not None", lambda: prostm.FocalPath([[0, 0]], 1.0, None)),
        ("Plan(): paths[1] must be a FocalPath, not 7", lambda: prostm.Plan([path, 7])),
        ("Plan(): paths must be a list of FocalPath, not a FocalPath", lambda: prostm.Plan(path)),
        ("Planner(): settings must be a PlanSettings, not 3", lambda: prostm.Planner(3)),
        ("Planner(): settings must be a PlanSettings, not an AmSettings",
         lambda: prostm.plan(field, settings=prostm.AmSettings())),
        ("target must be a TargetField, a TargetFrame or, to be planned, the name of a file, not an array",
         lambda: planner.plan(field.pressure)),
        ("Planner.plan(): frame must be a whole number or None, not 'last'", lambda: planner.plan("x.h5", frame="last")),
        ("read_field(): path must be the name of a file, not 3", lambda: prostm.read_field(3)),
        ("read_field(): frame must be a whole number or None, not 1.5", lambda: prostm.plan("x.h5", frame=1.5)),
        ("write_field(): field must be a TargetField, not a PlanResult",
         lambda: prostm.write_field(tmp_path / "x.json", result)),
        ("write_plan(): settings must be a PlanSettings or an AmSettings, not None",
         lambda: prostm.write_plan(tmp_path / "x.json", plan, field, None)),
        ("PlanResult.write(): path must be the name of a file, not 3", lambda: result.write(3)),
        ("Emitter.submit(): plan must be a LiftedPlan, not a Plan", lambda: emitter.submit(plan)),
        ("Emitter.fill(): samples must be a whole number, not 40.0", lambda: emitter.fill(0, 40.0)),
        ("Recording(): path must be the name of a file, not None", lambda: prostm.Recording(None)),
    ]:
        assert words in sentence_of(call)
    with pytest.raises(ValueError, match=r"score_plan\(\): patch = 1099511627776 is out of range"):
        prostm.score_plan(field, plan, patch=2**40)
    with pytest.raises(ValueError, match="leave out target"):
        prostm.lift(result, field)


def takes_an_argument(call):
    parameters = re.search(r"\w+\((.*?)\) ->", call.__doc__ or "")
    return parameters is None or parameters[1].removeprefix("self: ").count(": ") > 0


def test_no_function_responds_with_a_list_of_signatures(field):
    """Calls every function, constructor and method with an object that none accepts."""
    class Stranger:
        def __bool__(self):
            raise TypeError("a stranger is neither true nor false")

    calls = [value for value in map(prostm.__dict__.get, prostm.__all__)
             if inspect.isfunction(value) or (inspect.isclass(value) and takes_an_argument(value.__init__))]
    for owner in (prostm.Planner(), prostm.AmPlanner(), prostm.PathEmitter(full_scale_pressure=1.0),
                  prostm.plan(field, "fast")):
        members = [getattr(owner, name) for name in dir(owner) if not name.startswith("_")]
        calls += [member for member in members if inspect.ismethod(member) and takes_an_argument(member)]
    called = 0
    for call in calls:
        if inspect.isclass(call) and (issubclass(call, Exception) or "**kwargs" in call.__init__.__doc__):
            continue
        with pytest.raises((TypeError, ValueError)) as refused:
            call(Stranger())
        assert "\n" not in str(refused.value) and "incompatible" not in str(refused.value), call
        called += 1
    assert called > 30


def test_wrappers_pass_results_and_other_errors_through(field, plan):
    assert prostm.score_plan.__name__ == "score_plan" and prostm.Planner.plan.__qualname__ == "Planner.plan"
    assert prostm.score_plan(target=field, plan=plan).as_dict() == prostm.score_plan(field, plan).as_dict()
    with pytest.raises(TypeError, match="PlanSettings.paths must be a whole number, not 2.5"):
        prostm.Planner(paths=2.5)
