#!/usr/bin/env python3
"""Makes expected.jsonl: statistics of 1000 random data sets by scipy and statsmodels (apt: python3-statsmodels).

usage: tests/study/make_expected.py > tests/study/expected.jsonl

A line has right answers of each participant of two groups, out of as many trials, and what the tests of
statistics_test.cpp expect of them; null where a test has no result.
"""

import itertools
import json
import math
import sys
import warnings

import numpy as np
import statsmodels.api as sm
from scipy import stats
from statsmodels.stats.power import TTestIndPower, TTestPower
from statsmodels.stats.proportion import proportion_confint, proportions_ztest
from statsmodels.tools.sm_exceptions import PerfectSeparationError

SETS = 1000
CHANCES = (0.5, 0.25, 1 / 3)


def number(value):
    """Twelve digits; null for non-finite values."""
    value = float(value)
    return float(f"{value:.12g}") if math.isfinite(value) else None


def permutation(a, b):
    """Fraction of all splits whose means differ as much, by plain enumeration."""
    both = np.concatenate([a, b])
    chosen = np.array(list(itertools.combinations(range(len(both)), len(a))))
    inside = both[chosen].sum(axis=1)
    differ = np.abs((both.sum() - inside) / len(b) - inside / len(a))
    return np.mean(differ >= abs(b.mean() - a.mean()) - 1e-9)


def paired_permutation(change):
    signs = np.array(list(itertools.product((1, -1), repeat=len(change))))
    return np.mean(np.abs(signs @ change) >= abs(change.sum()) - 1e-9)


def dispersion(counts, trials):
    table = np.array([counts, trials - counts])
    if table.min(axis=None) < 0 or 0 in table.sum(axis=1):
        return None
    chi, p, df, _ = stats.chi2_contingency(table, correction=False)
    return [number(chi), df, number(p)]


def d_prime(hits, false_alarms, trials):
    z = [stats.norm.ppf((x + 0.5) / (trials + 1)) for x in (hits, false_alarms)]
    return [number(z[0] - z[1]), number(-0.5 * (z[0] + z[1]))]


def test(result, df):
    return [number(result.statistic), number(df), number(result.pvalue)] if math.isfinite(result.pvalue) else None


def welch(a, b):
    spread = [x.var(ddof=1) / len(x) for x in (a, b)]
    if sum(spread) < 1e-20:
        return None
    df = sum(spread) ** 2 / sum(s**2 / (len(x) - 1) for s, x in zip(spread, (a, b)))
    return test(stats.ttest_ind(b, a, equal_var=False), df)


def logistic(random):
    """Right answers at some levels, and the threshold and slope of a logistic regression on them; "step" if any steep
    slope fits, null if they are outside the range of fit_psychometric or statsmodels finds none."""
    levels = np.unique(random.uniform(0, 1, size=int(random.integers(3, 9))).round(3))
    trials = random.integers(5, 40, size=len(levels))
    slope = 10 ** random.uniform(0.3, 1.5)
    right = random.binomial(trials, 1 / (1 + np.exp(-slope * (levels - random.uniform(0.2, 0.8)))))
    return {"levels": levels.tolist(), "trials": trials.tolist(), "right": right.tolist(),
            "fit": logistic_fit(levels, trials, right)}


def is_step(trials, right):
    """Whether the answers change from all wrong to all right at one level or between two: any steep slope fits."""
    mixed = np.flatnonzero((right > 0) & (right < trials))
    if len(mixed) > 1:
        return False
    first, last = (mixed[0], mixed[0] + 1) if len(mixed) else (np.count_nonzero(right == 0),) * 2
    return not right[:first].any() and not (trials - right)[last:].any()


def logistic_fit(levels, trials, right):
    if is_step(trials, right):
        return "step"
    model = sm.GLM(np.column_stack([right, trials - right]), sm.add_constant(levels), family=sm.families.Binomial())
    try:
        a, b = model.fit(tol=1e-14, maxiter=200).params
    except PerfectSeparationError:  # also raised if two proportions between 0 and 1 are fitted exactly
        return None
    width = np.ptp(levels)
    found = 0.1 / width < b < 100 / width and abs(-a / b - levels[0] - width / 2) < 1.5 * width
    return [number(-a / b), number(b)] if found else None


def data_set(random):
    trials = int(random.integers(2, 41))
    sizes = random.integers(2, 9, size=2)
    if random.random() < 0.5:
        sizes[1] = sizes[0]
    shares = random.beta(4, 3, size=2)
    spread = 10 ** random.uniform(0, 2)  # of a beta distribution: small means over-dispersed
    a, b = (random.binomial(trials, random.beta(spread * s, spread * (1 - s), size=n)) for s, n in zip(shares, sizes))
    chance = CHANCES[int(random.integers(len(CHANCES)))]
    total, all_ = [a.sum(), b.sum()], [trials * len(a), trials * len(b)]
    z, p = proportions_ztest(total[::-1], all_[::-1])
    x, y = a / trials, b / trials
    pairs = len(a) == len(b)
    constant = pairs and np.ptp(b - a) == 0
    d, n = float(f"{random.uniform(0.1, 2.5):.3g}"), int(random.integers(2, 60))
    return {
        "trials": trials, "a": a.tolist(), "b": b.tolist(), "chance": chance,
        "wilson": [number(v) for v in proportion_confint(total[0], all_[0], method="wilson")],
        "z": [number(z), number(p)] if math.isfinite(z) else [0.0, 1.0],
        "fisher": number(stats.fisher_exact([[total[0], all_[0] - total[0]], [total[1], all_[1] - total[1]]])[1]),
        "binomial": number(stats.binomtest(int(total[0]), all_[0], chance).pvalue),
        "dispersion": dispersion(a, trials),
        "sensitivity": d_prime(a[0], b[0], trials),
        "welch": welch(x, y),
        "paired": None if not pairs or constant else test(stats.ttest_rel(y, x), len(a) - 1),
        "permutation": number(permutation(x, y)),
        "paired_permutation": number(paired_permutation(y - x)) if pairs else None,
        "logistic": logistic(random),
        "power": [d, n, number(TTestIndPower().power(d, n, 0.05)), number(TTestPower().power(d, n, 0.05))],
    }


def main():
    warnings.simplefilter("ignore")
    random = np.random.default_rng(19)
    for _ in range(SETS):
        json.dump(data_set(random), sys.stdout, separators=(",", ":"))
        print()


if __name__ == "__main__":
    main()
