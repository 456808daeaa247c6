/// Experiments as files, their predictions and losses, and the fit.
#include "prostm/psychophysics/experiment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "prostm/core/input_error.hpp"
#include "prostm/psychophysics/fit.hpp"
#include "prostm/psychophysics/prediction.hpp"

namespace prostm {
namespace {

const std::string kExample = R"({
  "format": "prostm-experiment/1", "id": "example", "title": "An example", "paper": "None",
  "paper_id": "none", "set": "fit", "participants": "2", "note": "", "height_mm": 200,
  "stimuli": {
    "point": {"kind": "am", "points_mm": [[0, 0]], "frequencies_hz": [200]},
    "disk": {"kind": "disk", "area_cm2": 1.8, "force_mn": 0.4, "frequency_hz": 200}
  },
  "cells": [
    {"name": "force", "task": "force-threshold", "stimuli": ["disk"], "value": 0.4, "low": 0.3,
     "high": 0.5, "source": "text"},
    {"name": "same", "task": "stronger", "stimuli": ["point", "point"], "value": 0.6, "trials": 10,
     "low": 0.3, "high": 0.8, "source": "text"}
  ],
  "agreement": {"least": 2}
})";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, text.npos) << what;
  return text.replace(at, what.size(), with);
}

TEST(Experiments, AreReadWithTheirUnits) {
  const Experiment of = parse_experiment(kExample, "example.json");
  EXPECT_EQ(of.height, 0.2);
  const auto& disk = std::get<Disk>(of.stimuli.at("disk"));
  EXPECT_NEAR(disk.force, 0.4e-3, 1e-12);
  EXPECT_NEAR(disk.area, 1.8e-4, 1e-12);
  EXPECT_EQ(of.cells.size(), 2U);
  EXPECT_EQ(of.cells[1].trials, 10);
}

TEST(Experiments, BadFilesAreRefusedWithTheirPlace) {
  const struct {
    std::string what, with, sentence;
  } cases[] = {
      {"\"kind\": \"am\"", "\"kind\": \"fm\"", ".point.kind"},
      {"\"stimuli\": [\"disk\"]", "\"stimuli\": [\"dish\"]", "must be a stimulus"},
      {"\"stimuli\": [\"point\", \"point\"]", "\"stimuli\": [\"point\"]", "two stimuli"},
      {"\"value\": 0.6", "\"value\": 6", "between 0 and 1"},
      {"\"low\": 0.3, \"high\": 0.8", "\"low\": 0.8, \"high\": 0.3", "low below high"},
      {"\"least\": 2", "\"least\": 3", "agreement"},
      {"\"least\": 2", "\"least\": 2, \"rms\": 1", "not both"},
      {"\"task\": \"stronger\"", "\"task\": \"weaker\"", "task"},
      {"\"set\": \"fit\"", "\"set\": \"both\"", "set"},
      {"\"frequency_hz\": 200}", "\"frequency_hz\": 200, \"pulse_ms\": 10}", "not both"},
      {"\"force_mn\": 0.4", "\"force\": 0.4", "force"},
  };
  for (const auto& [what, with, sentence] : cases) {
    try {
      parse_experiment(replaced(kExample, what, with), "example.json");
      ADD_FAILURE() << with;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("example.json"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(sentence), std::string::npos) << e.what();
    }
  }
}

TEST(Experiments, ThePublishedOnesAreComplete) {
  std::set<std::string> papers, held_out;
  for (const Experiment& of : published_experiments()) {
    papers.insert(of.paper_id);
    if (of.set == ExperimentSet::HeldOut) held_out.insert(of.paper_id);
  }
  EXPECT_GE(published_experiments().size(), 12U);
  EXPECT_GE(papers.size(), 8U);
  // a paper is fitted or held out, never both
  for (const Experiment& of : published_experiments())
    EXPECT_EQ(of.set == ExperimentSet::HeldOut, held_out.contains(of.paper_id)) << of.id;
}

TEST(Losses, HaveTheirClosedForms) {
  Cell cell;
  cell.task = ExperimentTask::Gap;
  cell.value = 30.0;
  cell.low = 28.04;
  cell.high = 31.96;  // one standard error is 1
  EXPECT_NEAR(loss_of(cell, 32.0), 2.0, 1e-9);
  EXPECT_NEAR(loss_of(cell, 30.0), 0.0, 1e-9);
  EXPECT_EQ(loss_of(cell, 1000.0), 8.0);
  EXPECT_EQ(loss_of(cell, std::nullopt), 2.0);

  Cell bound;
  bound.task = ExperimentTask::StrengthRatio;
  bound.low = 0.0;
  EXPECT_EQ(loss_of(bound, 0.1), 0.0);
  EXPECT_EQ(loss_of(bound, -0.1), 2.0);
  EXPECT_EQ(loss_of(bound, std::nullopt), 1.0);

  Cell counted;
  counted.task = ExperimentTask::Stronger;
  counted.value = 0.7;
  counted.trials = 10;
  EXPECT_NEAR(loss_of(counted, 0.7), 0.0, 1e-12);
  // ln of the ratio of binomial probabilities
  EXPECT_NEAR(loss_of(counted, 0.5), 7 * std::log(0.7 / 0.5) + 3 * std::log(0.3 / 0.5), 1e-12);
  EXPECT_NEAR(loss_of(counted, std::nullopt), loss_of(counted, 0.5), 1e-12);
}

TEST(Losses, APaperWeighsOne) {
  const Experiment a = parse_experiment(kExample, "a.json");
  Experiment b = a;
  b.id = "second";
  b.cells.resize(1);
  std::vector<PredictedExperiment> predicted;
  predicted.push_back({&a, {{}, {}}, 3.0, false});
  predicted.push_back({&b, {{}}, 0.0, true});
  const auto papers = paper_losses(predicted);
  ASSERT_EQ(papers.size(), 1U);
  EXPECT_NEAR(papers.front().loss, 2.0, 1e-12);  // three cells, two of loss 3
  EXPECT_NEAR(sum_of(papers, ExperimentSet::Fit), 2.0, 1e-12);
  EXPECT_EQ(sum_of(papers, ExperimentSet::HeldOut), 0.0);
  EXPECT_NEAR(sum_without(papers, "no paper"), 2.0, 1e-12);
  EXPECT_NEAR(sum_without(papers, papers[0].paper_id), 2.0 - papers[0].loss, 1e-12);
}

TEST(Predictions, AForceThresholdIsProportionalToTheThreshold) {
  Laboratory laboratory(SkinSettings{}, at_measured_amplitude(usx_array()), [] {});
  const Experiment of = parse_experiment(kExample, "example.json");
  const auto force = [&](double threshold) {
    const Observer observer(PerceptModel::Peak, Readout::Template, {.threshold = threshold});
    return *laboratory.predict(observer, of, of.cells[0]);
  };
  EXPECT_NEAR(force(2e-8) / force(1e-8), 2.0, 1e-12);
  const Observer observer(PerceptModel::Peak, Readout::Template, {.threshold = 1e-8});
  EXPECT_NEAR(*laboratory.predict(observer, of, of.cells[1]), 0.5, 1e-12);
}

TEST(Fits, FindTheThresholdThatAForceDetermines) {
  Laboratory laboratory(SkinSettings{}, at_measured_amplitude(usx_array()), [] {});
  const Experiment of = parse_experiment(kExample, "example.json");
  const FittedObserver fitted =
      fit_observer(laboratory, PerceptModel::Area, Readout::Template, std::array{&of});
  const Observer observer = fitted.observer();
  EXPECT_NEAR(*laboratory.predict(observer, of, of.cells[0]), 0.4, 0.02);
  EXPECT_TRUE(fitted.ranges[0].determined);
  EXPECT_LT(fitted.ranges[0].low, fitted.parameters.threshold);
  EXPECT_GT(fitted.ranges[0].high, fitted.parameters.threshold);
  // nothing here depends on the noise of places
  EXPECT_FALSE(fitted.ranges[1].determined);
}

TEST(Fits, AreReadBackAsWritten) {
  FittedObserver of{.model = PerceptModel::Population, .readout = Readout::Category};
  of.parameters = {.threshold = 1.25e-8, .noise = 0.25, .criterion = 0.5, .place = 0.006};
  of.ranges[0] = {1e-8, 2e-8, true};
  of.loss = 0.75;
  const Experiment example = parse_experiment(kExample, "example.json");
  const std::string text = observers_text(std::array{of}, std::array{&example});
  const auto read = parse_observers(text, "observers.json");
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].model, of.model);
  EXPECT_EQ(read[0].parameters.threshold, of.parameters.threshold);
  EXPECT_EQ(read[0].parameters.place, of.parameters.place);
  EXPECT_EQ(read[0].ranges[0].high, of.ranges[0].high);
  EXPECT_TRUE(read[0].ranges[0].determined);
  EXPECT_EQ(read[0].loss, of.loss);
  EXPECT_EQ(frozen_hash().size(), 64U);
}

}  // namespace
}  // namespace prostm
