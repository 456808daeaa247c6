#!/usr/bin/env python3
"""Makes expected_effects.jsonl: sizes of differences of 300 random data sets by scipy and statsmodels.

usage: tests/study/analysis/make_expected_effects.py > tests/study/analysis/expected_effects.jsonl
       tests/study/analysis/make_expected_effects.py --check     compares the first lines of the file with scipy

Needs scipy; without --check also statsmodels 0.13 or newer (apt: python3-statsmodels). A line has values of two methods
and what effects_test.cpp expects of them: intervals of the difference and of d, two one-sided t tests, Bayes factors,
Holm's correction, and abilities by Bradley and Terry's model. The Bayes factor is the integral of the noncentral t
density over the Cauchy prior of effect sizes, which prostm computes in another way.
"""

import json
import math
import sys
from pathlib import Path

import numpy as np
from scipy import integrate, optimize, stats

SETS = 300
CHECKED = 40
SCALE = math.sqrt(0.5)


def number(value):
    return float(f"{float(value):.12g}")


def d_interval(t, n, df, level):
    """Returns the interval of d by the noncentral t distribution."""
    def shift(share):
        def off(x):
            return stats.nct.cdf(t, df, x) - share
        low, high, step = t, t, 0.5
        while off(low) < 0:
            low, step = low - step, 1.5 * step
        step = 0.5
        while off(high) > 0:
            high, step = high + step, 1.5 * step
        return optimize.brentq(off, low, high, xtol=1e-12, rtol=1e-14)
    return [number(shift(0.5 + 0.5 * level) / math.sqrt(n)), number(shift(0.5 - 0.5 * level) / math.sqrt(n))]


def bayes_factor(t, n, df):
    def density(angle):  # the effect size is SCALE tan(angle), with the prior density 1 / pi of the angle
        return stats.nct.pdf(t, df, SCALE * math.tan(angle) * math.sqrt(n)) / math.pi
    peak = math.atan(t / math.sqrt(n) / SCALE)
    ends = sorted({-math.pi / 2 + 1e-9, peak - 0.3, peak - 0.1, peak, peak + 0.1, peak + 0.3, math.pi / 2 - 1e-9})
    ends = [x for x in ends if abs(x) < math.pi / 2]
    parts = [integrate.quad(density, a, b, epsabs=0, epsrel=1e-11, limit=400)[0] for a, b in zip(ends, ends[1:])]
    return number(sum(parts) / stats.t.pdf(t, df))


def sizes(difference, error, df, t, n, t_df, bound, level):
    alpha = 1 - level
    half = [stats.t.ppf(1 - share, df) * error for share in (alpha / 2, alpha)]
    return {"difference": [number(difference), number(difference - half[0]), number(difference + half[0])],
            "d": [number(t / math.sqrt(n)), *d_interval(t, n, t_df, level)],
            "equal": [number(stats.t.sf((difference + bound) / error, df)),
                      number(stats.t.cdf((difference - bound) / error, df)),
                      number(difference - half[1]), number(difference + half[1])],
            "bayes_factor": bayes_factor(t, n, t_df)}


def of_groups(a, b, bound, level):
    spread = [x.var(ddof=1) / len(x) for x in (a, b)]
    df = sum(spread) ** 2 / sum(s**2 / (len(x) - 1) for s, x in zip(spread, (a, b)))
    pooled = stats.ttest_ind(b, a)
    n = len(a) * len(b) / (len(a) + len(b))
    return sizes(b.mean() - a.mean(), math.sqrt(sum(spread)), df, pooled.statistic, n, len(a) + len(b) - 2, bound, level)


def of_pairs(a, b, bound, level):
    change = b - a
    n = len(change)
    error = change.std(ddof=1) / math.sqrt(n)
    return sizes(change.mean(), error, n - 1, stats.ttest_rel(b, a).statistic, n, n - 1, bound, level)


def holm(p):
    from statsmodels.stats.multitest import multipletests
    return [number(x) for x in multipletests(p, method="holm")[1]]


def bradley_terry(random):
    """Wins of stimuli over each other, and abilities over the first by a logistic regression without an intercept."""
    import statsmodels.api as sm
    while True:
        k = int(random.integers(2, 7))
        ability = random.normal(0, 0.8, size=k)
        rows, wins = [], np.zeros((k, k))
        for i in range(k):
            for j in range(i):
                n = int(random.integers(3, 30))
                won = random.binomial(n, 1 / (1 + math.exp(ability[j] - ability[i])))
                wins[i, j], wins[j, i] = won, n - won
                row = np.zeros(k)
                row[i], row[j] = 1, -1
                rows.append((row, won, n - won))
        # paths of wins from each to each
        if np.all(np.linalg.matrix_power((wins > 0) + np.eye(k), k) > 0):
            break
    x = np.array([row[1:] for row, _, _ in rows])
    fit = sm.GLM(np.array([[won, lost] for _, won, lost in rows]), x, family=sm.families.Binomial()).fit(tol=1e-14)
    return {"wins": wins.astype(int).tolist(), "ability": [number(v) for v in fit.params],
            "error": [number(v) for v in fit.bse], "p": [number(v) for v in fit.pvalues],
            "deviance": number(fit.deviance)}


def values(random):
    n, m = (int(x) for x in random.integers(2, 31, size=2))
    if random.random() < 0.6:
        m = n
    spread = random.uniform(0.05, 0.3)
    a = np.round(random.normal(0.6, spread, size=n), 3)
    b = np.round(random.normal(0.6 + random.choice([0, 0.05, 0.2, 0.4]), spread, size=m), 3)
    return a, b, round(float(random.uniform(0.02, 0.3)), 3), float(random.choice([0.9, 0.95, 0.99]))


def data_set(random):
    while True:
        a, b, bound, level = values(random)
        if np.ptp(a) > 0 and np.ptp(b) > 0 and (len(a) != len(b) or np.ptp(b - a) > 1e-6):
            break
    p = [float(f"{x:.6g}") for x in random.uniform(0, 1, size=int(random.integers(1, 9))) ** 3]
    return {"a": a.tolist(), "b": b.tolist(), "bound": bound, "level": level,
            "groups": of_groups(a, b, bound, level),
            "pairs": of_pairs(a, b, bound, level) if len(a) == len(b) else None,
            "p": p, "holm": holm(p), "bradley_terry": bradley_terry(random)}


def differs(found, expected):
    if isinstance(expected, dict):
        return any(differs(found[key], expected[key]) for key in expected)
    if isinstance(expected, list):
        return any(map(differs, found, expected))
    return abs(found - expected) > 1e-6 * (1 + abs(expected))


def check():
    lines = (Path(__file__).parent / "expected_effects.jsonl").read_text().splitlines()
    for place, text in enumerate(lines[:CHECKED], 1):
        line = json.loads(text)
        a, b, bound, level = np.array(line["a"]), np.array(line["b"]), line["bound"], line["level"]
        found = [of_groups(a, b, bound, level)] + ([of_pairs(a, b, bound, level)] if line["pairs"] else [])
        if any(map(differs, found, [line["groups"], line["pairs"]])):
            return f"expected_effects.jsonl, line {place}: scipy has {found}"
    return None


def main():
    if sys.argv[1:] == ["--check"]:
        sys.exit(check())
    random = np.random.default_rng(23)
    for _ in range(SETS):
        json.dump(data_set(random), sys.stdout, separators=(",", ":"))
        print()


if __name__ == "__main__":
    main()
