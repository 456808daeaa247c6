#pragma once
/// Checks that answers with the same method and scene names are about the same stimuli.

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/answer.hpp"

namespace prostm::study {

/// The study of a participant's file.
struct StudyFile {
  std::string participant;          ///< name as in the answers
  nlohmann::ordered_json protocol;  ///< with all settings of all methods; any part may be missing
  bool rehearsal = false;
};

/// Compares the settings of methods, levels and standards in participants' files, the checksums of
/// stimuli in answers, and whether files are rehearsals. @param pool note differences instead of
/// refusing them. @param notes receives sentences about other differences: parts of protocols,
/// devices, arrays, hands, versions. @throws InputError: different stimuli have the same name.
void require_same_stimuli(std::span<const Answer> answers, std::span<const StudyFile> files,
                          bool pool, std::vector<std::string>& notes);

}  // namespace prostm::study
