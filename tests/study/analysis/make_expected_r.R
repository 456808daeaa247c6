#!/usr/bin/env Rscript
# Makes expected_r.jsonl: statistics of 240 random tables by R, for r_reference_test.cpp.
#
# usage: tests/study/analysis/make_expected_r.R > tests/study/analysis/expected_r.jsonl
#
# Needs the packages BayesFactor, BradleyTerry2 and jsonlite (apt: r-cran-bayesfactor, r-cran-bradleyterry2,
# r-cran-jsonlite). The file was made with R 4.2.2, BayesFactor 0.9.12-4.4 and BradleyTerry2 1.1.2. A line has
#
#   a, b       values of two methods
#   groups     their difference b - a as of two groups: t, df, p and interval of t.test(), two one-sided p at -bound and
#              bound, and the JZS Bayes factor of ttestBF() with its default scale sqrt(2) / 2, null beyond |t| = 15
#   pairs      the same as of pairs; null if sizes differ
#   p, holm    p values, and p.adjust() of them
#   counts     right answers and trials of two methods, with prop.test() and fisher.test() of both, and the interval of
#              prop.test() and binom.test() of the first
#   wins       wins[i][k]: times that stimulus i was preferred to stimulus k
#   abilities  of the stimuli by BTm(): over the first stimulus, which is the reference category and has 0 with error 0,
#              and over the mean of all stimuli, which is the parametrisation of prostm. With the covariance V of the
#              former and C = 1 - 1/k, the latter has the covariance C V C.

suppressPackageStartupMessages({
  library(BayesFactor)
  library(BradleyTerry2)
})

TABLES <- 240

# The Bayes factor by quadrature. Beyond |t| = 15 ttestBF() says that it approximates, to about 1e-3: NULL.
bayes_factor <- function(a, b, paired) {
  exact <- TRUE
  found <- withCallingHandlers(ttestBF(b, a, paired = paired, rscale = sqrt(2) / 2), message = function(said) {
    exact <<- FALSE
    invokeRestart("muffleMessage")
  })
  if (exact) extractBF(found, onlybf = TRUE)[1]
}

of_samples <- function(a, b, bound, level, paired) {
  test <- function(...) t.test(b, a, paired = paired, ...)
  two_sided <- test(conf.level = level)
  list(t = unname(two_sided$statistic), df = unname(two_sided$parameter), p = two_sided$p.value,
       interval = as.numeric(two_sided$conf.int),
       above_low = test(mu = -bound, alternative = "greater")$p.value,
       below_high = test(mu = bound, alternative = "less")$p.value,
       bayes_factor = bayes_factor(a, b, paired))
}

of_counts <- function(level) {
  trials <- sample(5:60, 2, replace = TRUE)
  right <- rbinom(2, trials, runif(2, 0.3, 0.95))
  if (sum(right) %in% c(0, sum(trials))) right[1] <- trials[1] - right[1]  # no z without both kinds of answers
  both <- suppressWarnings(prop.test(right, trials, correct = FALSE))
  first <- suppressWarnings(prop.test(right[1], trials[1], conf.level = level, correct = FALSE))
  list(right = right, trials = trials, chi_squared = unname(both$statistic), p = both$p.value,
       fisher = fisher.test(rbind(right, trials - right))$p.value, wilson = as.numeric(first$conf.int),
       binomial = binom.test(right[1], trials[1], 0.5)$p.value)
}

# Whether each stimulus beats each other one directly or through others: abilities are finite.
is_connected <- function(wins) {
  reached <- diag(nrow(wins)) + (wins > 0)
  for (step in seq_len(nrow(wins))) reached <- (reached %*% reached > 0) + 0
  all(reached > 0)
}

random_wins <- function() {
  repeat {
    k <- sample(3:7, 1)
    ability <- rnorm(k, 0, 0.8)
    wins <- matrix(0, k, k)
    for (i in 2:k) {
      for (j in seq_len(i - 1)) {
        if (runif(1) < 0.15) next  # not all pairs are compared
        n <- sample(3:30, 1)
        wins[i, j] <- rbinom(1, n, plogis(ability[i] - ability[j]))
        wins[j, i] <- n - wins[i, j]
      }
    }
    if (is_connected(wins)) return(wins)
  }
}

of_wins <- function(wins) {
  k <- nrow(wins)
  names <- paste0("s", seq_len(k) - 1)
  pairs <- which(upper.tri(wins) & wins + t(wins) > 0, arr.ind = TRUE)
  games <- data.frame(won = wins[pairs], lost = t(wins)[pairs], one = factor(names[pairs[, 1]], levels = names),
                      other = factor(names[pairs[, 2]], levels = names))
  # until rounding, also where that is more than epsilon: the covariance is that of the last step but one
  fit <- suppressWarnings(BTm(cbind(won, lost), one, other, data = games, refcat = "s0", epsilon = 1e-14, maxit = 100))
  over_first <- BTabilities(fit)[names, ]
  centre <- diag(k) - 1 / k
  covariance <- matrix(0, k, k)
  covariance[-1, -1] <- vcov(fit)
  list(over_first = unname(over_first[, "ability"]), over_first_error = unname(over_first[, "s.e."]),
       over_mean = as.numeric(centre %*% over_first[, "ability"]),
       over_mean_error = sqrt(diag(centre %*% covariance %*% centre)),
       p = unname(summary(fit)$coefficients[, "Pr(>|z|)"]), deviance = deviance(fit), df = df.residual(fit))
}

random_table <- function() {
  n <- sample(4:40, 1)
  m <- if (runif(1) < 0.6) n else sample(4:40, 1)
  spread <- runif(1, 0.05, 0.3)
  a <- round(rnorm(n, 0.6, spread), 3)
  b <- round(rnorm(m, 0.6 + sample(c(0, 0.05, 0.2, 0.4), 1), spread * runif(1, 0.5, 2)), 3)
  bound <- round(runif(1, 0.02, 0.3), 3)
  level <- sample(c(0.9, 0.95, 0.99), 1)
  p <- signif(runif(sample(1:8, 1))^3, 6)
  wins <- random_wins()
  list(a = a, b = b, bound = bound, level = level, groups = of_samples(a, b, bound, level, FALSE),
       pairs = if (n == m) of_samples(a, b, bound, level, TRUE), p = I(p), holm = I(p.adjust(p, method = "holm")),
       counts = of_counts(level), wins = wins, abilities = of_wins(wins))
}

set.seed(31)
for (table in seq_len(TABLES)) {
  cat(jsonlite::toJSON(random_table(), auto_unbox = TRUE, digits = I(12), null = "null"), "\n", sep = "")
}
