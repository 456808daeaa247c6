#include "prostm/io/physical_file.hpp"

#include <nlohmann/json.hpp>

#include "prostm/core/text/json.hpp"
#include "prostm/core/units.hpp"
#include "prostm/io/detail/raster_json.hpp"
#include "prostm/io/plan_file.hpp"
#include "prostm/io/quantity_json.hpp"
#include "prostm/io/sensation_json.hpp"
#include "prostm/io/settings_file.hpp"

namespace prostm {
namespace {

using Json = nlohmann::ordered_json;

/// Rows of a raster, null where there is no skin.
Json matrix(const TargetField& raster, const std::vector<double>& values) {
  Json rows = Json::array();
  for (int row = 0; row < raster.rows; ++row) {
    Json line = Json::array();
    for (int col = 0; col < raster.cols; ++col) {
      const std::size_t cell = raster.index(row, col);
      line.push_back(raster.skin[cell] != 0 ? Json(values[cell]) : Json(nullptr));
    }
    rows.push_back(std::move(line));
  }
  return rows;
}

Json metrics_or_null(const Metrics* m) {
  return m == nullptr ? Json(nullptr) : quantities_to_json(*m);
}

Json loop_json(const LoopSamples& loop) {
  return {{"samples", loop.samples},
          {"duration_ms", to_milli(loop.samples / loop.sample_rate)},
          {"laps", loop.laps},
          {"stretch", loop.stretch}};
}

Json drives_json(const LoopDriveResult& drives) {
  return {{"full_scale_pa", drives.full_scale_pa}, {"short_samples", drives.short_samples},
          {"largest_drive", drives.largest_drive}, {"mean_power", drives.mean_power},
          {"full_drive_share", drives.full_share}, {"worst_focus_error", drives.worst_focus_error},
          {"merged_foci", drives.merged}};
}

Json focus_json(const FocusAccuracy& focus) {
  return {{"looked_at", focus.looked_at},
          {"mean_offset_mm", to_milli(focus.mean_offset)},
          {"worst_offset_mm", to_milli(focus.worst_offset)},
          {"mean_level", focus.mean_level},
          {"least_level", focus.least_level},
          {"most_level", focus.most_level}};
}

std::vector<double> in_micrometres(std::vector<double> values) {
  for (double& value : values) value *= 1e6;
  return values;
}

Json spectrum_json(const std::vector<FeltHarmonic>& spectrum) {
  if (spectrum.empty()) return nullptr;
  Json list = Json::array();
  for (const FeltHarmonic& h : spectrum) {
    list.push_back({{"frequency_hz", h.frequency},
                    {"share_at_strongest", h.share_at_strongest},
                    {"share_of_intensity", h.share_of_intensity},
                    {"strongest_um", 1e6 * h.displacement_strongest},
                    {"strongest_mm_s", 1e3 * h.velocity_strongest},
                    {"skin_um", 1e6 * h.displacement_skin},
                    {"skin_mm_s", 1e3 * h.velocity_skin}});
  }
  return list;
}

Json felt_json(const PhysicalReport& report) {
  if (report.felt == nullptr) return nullptr;
  Json felt = {{"largest_um", 1e6 * report.felt->largest},
               {"intensity_um", 1e6 * report.felt->intensity},
               {"sensation", sensation_to_json(report.sensation_level, report.sensation_interval)},
               {"metrics", metrics_or_null(report.felt_metrics)},
               {"ghosts", nullptr},
               {"strongest_ghost", nullptr},
               {"spectrum", spectrum_json(report.spectrum)}};
  if (report.ghosts != nullptr) {
    felt["ghosts"] = report.ghosts->count;
    felt["strongest_ghost"] = report.ghosts->largest;
  }
  return felt;
}

}  // namespace

std::string physical_to_json(const PhysicalReport& report) {
  const TransducerArray& array = *report.array;
  Json document = {{"format", "prostm-physical/1"},
                   {"plan", report.plan},
                   {"array", array.name},
                   {"amplitude_pa_m", array.amplitude},
                   {"amplitude_interval_pa_m", {array.amplitude_low, array.amplitude_high}},
                   {"solver", report.solver}};
  document["quality"] = metrics_or_null(report.quality);
  document["loop"] = loop_json(*report.loop);
  document["paths"] = played_to_json(report.loop->played);
  document["warnings"] = report.warnings;
  document["drives"] = drives_json(*report.drives);
  document["foci"] = focus_json(report.focus);
  document["envelope"] = {{"largest_pa", report.field->largest},
                          {"side_lobe", report.field->side_lobe},
                          {"metrics", metrics_or_null(report.envelope_metrics)}};
  document["mean"] = {{"largest_pa", report.field->largest_mean},
                      {"metrics", metrics_or_null(report.mean_metrics)}};
  document["felt"] = felt_json(report);
  document["plane"] = plane_json(report.raster->X_DP);
  Json raster = Json::object();
  write_raster(*report.raster, raster);
  document["raster"] = std::move(raster);
  document["envelope_pa"] = matrix(*report.raster, report.field->envelope);
  document["mean_pa"] = matrix(*report.raster, report.field->mean);
  document["felt_um"] = report.felt != nullptr
                            ? matrix(*report.raster, in_micrometres(report.felt->percept))
                            : Json();
  document["settings"] = settings_to_json(report.settings);
  if (!report.program.empty()) document["prostm"] = report.program;
  return to_text(document);
}

}  // namespace prostm
