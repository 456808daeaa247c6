#pragma once
/// Names in a participant's file (docs/study/study-files.md): kinds of lines, and the keys that
/// more than one part of prostm writes or reads.

namespace prostm::line {

// kinds of lines
inline constexpr const char* kBegin = "begin";
inline constexpr const char* kResume = "resume";
inline constexpr const char* kConsent = "consent";
inline constexpr const char* kAbout = "about";
inline constexpr const char* kTraining = "training";
inline constexpr const char* kPractised = "practised";
inline constexpr const char* kGo = "go";
inline constexpr const char* kTrial = "trial";  // also the key of its number
inline constexpr const char* kCorrection = "correction";
inline constexpr const char* kInterrupted = "interrupted";
inline constexpr const char* kBound = "bound";  // also a key
inline constexpr const char* kClock = "clock";
inline constexpr const char* kPage = "page";  // also a key of a trial
inline constexpr const char* kMarker = "marker";
inline constexpr const char* kPractiseAgain = "practise-again";
inline constexpr const char* kPause = "pause";
inline constexpr const char* kWithdrawn = "withdrawn";
inline constexpr const char* kEnd = "end";

// keys of any line
inline constexpr const char* kKind = "kind";

// keys of the first line
inline constexpr const char* kFormat = "format";
inline constexpr const char* kParticipant = "participant";
inline constexpr const char* kReplaces = "replaces";
inline constexpr const char* kOrder = "order";
inline constexpr const char* kProtocol = "protocol";
inline constexpr const char* kTrials = "trials";
inline constexpr const char* kRun = "run";

// keys of a trial
inline constexpr const char* kMethod = "method";
inline constexpr const char* kScene = "scene";
inline constexpr const char* kQuestion = "question";
inline constexpr const char* kTrack = "track";
inline constexpr const char* kLevel = "level";
inline constexpr const char* kReference = "reference";
inline constexpr const char* kInterval = "interval";
inline constexpr const char* kAnswer = "answer";
inline constexpr const char* kFelt = "felt";
inline constexpr const char* kCorrect = "correct";
inline constexpr const char* kResponseTime = "response_s";
inline constexpr const char* kStimulus = "stimulus";
inline constexpr const char* kGate = "gate";
inline constexpr const char* kAnyway = "anyway";
inline constexpr const char* kTarget = "target_mn";
inline constexpr const char* kRendered = "rendered_mn";
inline constexpr const char* kHandGone = "hand_gone_s";
inline constexpr const char* kPlayed = "played";
inline constexpr const char* kHand = "hand";
inline constexpr const char* kStart = "start";      // initial level of an adjustment
inline constexpr const char* kChanges = "changes";  // level changes of an adjustment

// keys of practice, catch and attention trials
inline constexpr const char* kRight = "right";
inline constexpr const char* kPassed = "passed";

// keys of the last line
inline constexpr const char* kStrengths = "strengths";

}  // namespace prostm::line
