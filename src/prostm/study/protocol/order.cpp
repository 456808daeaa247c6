#include "prostm/study/protocol/order.hpp"

#include <numeric>

namespace prostm {

Random random_for(const Protocol& protocol, Purpose purpose, std::uint32_t number) {
  std::seed_seq mixed{static_cast<std::uint32_t>(protocol.study.seed),
                      static_cast<std::uint32_t>(purpose), number};
  std::uint32_t words[2];
  mixed.generate(words, words + 2);
  return Random(std::uint64_t{words[0]} << 32 | words[1]);
}

namespace {

/// The row of this participant within their block, drawn at random.
std::size_t row_of(const Protocol& protocol, int participant, std::size_t rows) {
  const auto n = static_cast<std::size_t>(participant - 1);
  std::vector<std::size_t> order(rows);
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random random = random_for(protocol, Purpose::Methods, static_cast<std::uint32_t>(n / rows));
  random.shuffle(order);
  return order[n % rows];
}

/// The questions of one scene's trials.
std::vector<int> draw_questions(const Protocol& protocol, Random& random) {
  const int scenes = static_cast<int>(protocol.scenes.size());
  std::vector<int> questions(static_cast<std::size_t>(protocol.trials.repeats));
  if (protocol.trials.questions == Questions::Random) {
    for (int& q : questions) q = random.below(scenes);
    return questions;
  }
  // if the scenes do not divide the number evenly, those with one more are drawn, too
  std::vector<int> all(static_cast<std::size_t>(scenes));
  std::iota(all.begin(), all.end(), 0);
  random.shuffle(all);
  for (std::size_t i = 0; i < questions.size(); ++i) questions[i] = all[i % all.size()];
  return questions;
}

}  // namespace

std::vector<std::vector<int>> williams_rows(int n) {
  std::vector<std::vector<int>> rows;
  std::vector<int> first;  // 0, 1, n−1, 2, n−2, …
  for (int i = 0; i < n; ++i) first.push_back(i == 0 ? 0 : i % 2 == 1 ? (i + 1) / 2 : n - i / 2);
  for (int shift = 0; shift < n; ++shift) {
    std::vector<int>& row = rows.emplace_back();
    for (const int method : first) row.push_back((method + shift) % n);
  }
  if (n % 2 == 0 || n == 1) return rows;
  std::vector<std::vector<int>> all = rows;
  for (const std::vector<int>& row : rows) all.emplace_back(row.rbegin(), row.rend());
  return all;
}

std::vector<int> method_order(const Protocol& protocol, int participant) {
  const int n = static_cast<int>(protocol.methods.size());
  if (protocol.study.methods == MethodsOf::Between)
    return {static_cast<int>(row_of(protocol, participant, static_cast<std::size_t>(n)))};
  const std::vector<std::vector<int>> rows = williams_rows(n);
  return rows[row_of(protocol, participant, rows.size())];
}

std::vector<Trial> trial_order(const Protocol& protocol, int participant) {
  Random random = random_for(protocol, Purpose::Trials, static_cast<std::uint32_t>(participant));
  std::vector<Trial> trials;
  for (const int method : method_order(protocol, participant)) {
    std::vector<Trial> block;
    for (int scene = 0; scene < static_cast<int>(protocol.scenes.size()); ++scene)
      for (const int question : draw_questions(protocol, random))
        block.push_back({method, scene, question});
    random.shuffle(block);
    trials.insert(trials.end(), block.begin(), block.end());
  }
  return trials;
}

}  // namespace prostm
