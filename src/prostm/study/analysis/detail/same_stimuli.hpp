#pragma once
/// Whether answers that have the same names are answers to the same stimuli.

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/answer.hpp"

namespace prostm::study {

/// The study of a participant's file.
struct StudyFile {
  std::string participant;          ///< as in the answers
  nlohmann::ordered_json protocol;  ///< with all settings of all methods; may lack any part
  bool rehearsal = false;
};

/// Compares the settings of methods, levels and standards of participants' files, the checksums of
/// stimuli in answers, and whether answers were made up. @param pool what differs is noted, not
/// refused. @param notes gets sentences about other differences: parts of protocols, devices,
/// arrays, hands, versions. @throws InputError: stimuli that have one name differ.
void require_same_stimuli(std::span<const Answer> answers, std::span<const StudyFile> files,
                          bool pool, std::vector<std::string>& notes);

}  // namespace prostm::study
