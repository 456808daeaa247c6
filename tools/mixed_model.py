#!/usr/bin/env python3
"""Models right and wrong answers by method and scene, with correlated answers of a participant.

usage: mixed_model.py TIDY.csv     TIDY.csv is written by prostm study analyse ANSWERS --tidy TIDY.csv

Prints odds ratios over the first method and scene of the table, with 95 % intervals and p. Needs pandas and
statsmodels 0.13 or newer (apt: python3-statsmodels).

The model is of generalised estimating equations: correct ~ method * scene, with one correlation between any two answers
of a participant and the sandwich variance corrected for few participants (L. A. Mancl and T. A. DeRouen, Biometrics 57,
126 (2001)). statsmodels has no mixed logistic model by maximum likelihood. Its BinomialBayesMixedGLM gives posteriors
that depend on a prior and, by variational Bayes, are too narrow. Estimating equations are valid even if the correlation
has another structure. Their odds ratios are population averages, nearer to 1 than those of one person by mixed_model.R.
"""

import sys
import warnings

try:
    import numpy as np
    import pandas as pd
    import statsmodels.api as sm
    import statsmodels.formula.api as smf
except ModuleNotFoundError as error:
    sys.exit(f"mixed_model needs pandas and statsmodels (apt: python3-statsmodels): {error}")

NEEDED = ("participant", "method", "scene", "correct")


def read(path):
    """Returns the table, with methods and scenes in the order in which they come first."""
    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    for name in NEEDED:
        if name not in table:
            raise ValueError(f"{path} has no column {name}: write it by prostm study analyse ANSWERS --tidy {path}")
    table = table[table["correct"] != ""].copy()  # trials without an answer are left out
    table["correct"] = table["correct"].astype(int)
    for name in ("method", "scene"):
        table[name] = pd.Categorical(table[name], categories=table[name].unique())
    return table


def fit(table):
    terms = [name for name in ("method", "scene") if len(table[name].cat.categories) > 1]
    model = smf.gee("correct ~ " + (" * ".join(terms) or "1"), groups="participant", data=table,
                    family=sm.families.Binomial(), cov_struct=sm.cov_struct.Exchangeable())
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # a fit that has not converged is an error
        return model.fit(cov_type="bias_reduced")


def main():
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip())
        return 0 if sys.argv[1:] in (["-h"], ["--help"]) else 2
    try:
        table = read(sys.argv[1])
        result = fit(table)
    except (OSError, ValueError, Warning) as error:
        print(f"mixed_model: {error}", file=sys.stderr)
        return 2
    print(f"{len(table)} answers of {table['participant'].nunique()} participants")
    print(f"correlation of two answers of one: {result.model.cov_struct.dep_params:.3f}")
    rows = zip(result.params.index, np.exp(result.params), np.exp(result.conf_int().to_numpy()), result.pvalues)
    width = max(len(name) for name in result.params.index)
    print(f"{'term':<{width}}  {'odds ratio':>10}  {'95 % interval':>20}  {'p':>6}")
    for name, ratio, (low, high), p in rows:
        shown = f"{p:.4f}" if p >= 1e-4 else "<.0001"
        print(f"{name:<{width}}  {ratio:>10.3f}  {f'{low:.3f} to {high:.3f}':>20}  {shown:>6}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
