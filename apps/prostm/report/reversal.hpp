#pragma once
/// Explanations of why people did the paper's study better with PRO-STM, tested one by one.

#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "prostm/psychophysics/fit.hpp"

namespace prostm::app {

/// Simulates the paper's study in each of its variations, prints the right answers of each observer
/// with and without its threshold, (X10), and how often chance alone gives a difference as large as
/// the paper's. Takes some minutes for each variation. @param go_on called repeatedly; returns
/// false to stop. @return the printed rows. @throws StudyStopped
nlohmann::ordered_json print_reversal(std::FILE* out, const std::vector<FittedObserver>& observers,
                                      int hands, const std::function<bool()>& go_on);

}  // namespace prostm::app
