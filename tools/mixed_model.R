#!/usr/bin/env Rscript
# Fits right and wrong answers to methods and scenes, with answers of one participant alike: a mixed logistic model,
# correct ~ method * scene + (1 | participant), by lme4.
#
# usage: Rscript mixed_model.R TIDY.csv     TIDY.csv is written by prostm study analyse ANSWERS --tidy TIDY.csv
#
# Prints odds ratios of one person over the first method and scene of the table, with Wald's 95 % intervals and p.

arguments <- commandArgs(trailingOnly = TRUE)
if (length(arguments) != 1) {
  message("usage: Rscript mixed_model.R TIDY.csv")
  quit(status = 2)
}
table <- read.csv(arguments[1], colClasses = "character", na.strings = character(0))
missing <- setdiff(c("participant", "method", "scene", "correct"), names(table))
if (length(missing) > 0) {
  message("mixed_model: ", arguments[1], " has no column ", missing[1],
          ": write it by prostm study analyse ANSWERS --tidy ", arguments[1])
  quit(status = 2)
}
table <- table[table$correct != "", ]  # trials without an answer are left out
table$correct <- as.integer(table$correct)
for (name in c("method", "scene")) table[[name]] <- factor(table[[name]], levels = unique(table[[name]]))
terms <- Filter(function(name) nlevels(table[[name]]) > 1, c("method", "scene"))
fixed <- if (length(terms) > 0) paste(terms, collapse = " * ") else "1"
fit <- lme4::glmer(as.formula(paste("correct ~", fixed, "+ (1 | participant)")), data = table, family = binomial)
found <- summary(fit)$coefficients
log_odds <- found[, "Estimate"]
error <- qnorm(0.975) * found[, "Std. Error"]
cat(nrow(table), "answers of", length(unique(table$participant)), "participants\n")
cat("standard deviation between participants:", format(attr(lme4::VarCorr(fit)$participant, "stddev"), digits = 3), "\n")
print(data.frame("odds ratio" = exp(log_odds), "from" = exp(log_odds - error), "to" = exp(log_odds + error),
                 "p" = found[, "Pr(>|z|)"], row.names = rownames(found), check.names = FALSE), digits = 3)
