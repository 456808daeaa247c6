#include "prostm/track/live/tracker_news.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace prostm {
namespace {

TrackerStatus status_of(bool connected, std::int64_t frames, const std::string& sentence) {
  TrackerStatus status;
  status.connected = connected;
  status.frames = frames;
  status.sentence = sentence;
  return status;
}
const TrackerStatus kAbsent = status_of(false, 0, "nothing answers");
const TrackerStatus kThere = status_of(true, 5, "connected");
const TrackerStatus kMute = status_of(true, 0, "connected");
const TrackerStatus kCut = status_of(false, 5, "the connection was lost");

/// All messages about a tracker that is `status` from `begin` to `end`, polled every 50 ms.
std::vector<std::string> told(TrackerNews& news, const TrackerStatus& status, double begin,
                              double end) {
  std::vector<std::string> all;
  for (double t = begin; t < end; t += 0.05) {
    if (auto sentence = news.look(status, t)) all.push_back(*sentence);
  }
  return all;
}

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST(TrackerNews, ReportsAMissingTrackerOnceWithinTwoSeconds) {
  TrackerNews news;
  EXPECT_THAT(told(news, kAbsent, 0.0, 1.4), IsEmpty());
  EXPECT_THAT(told(news, kAbsent, 1.4, 2.0),
              ElementsAre(testing::AllOf(StartsWith("No tracker yet: nothing answers. "),
                                         HasSubstr("keeps trying"))));
  EXPECT_THAT(told(news, kAbsent, 2.0, 60.0), IsEmpty());
}

TEST(TrackerNews, ReportsEachChangeOnce) {
  TrackerNews news;
  EXPECT_THAT(told(news, kAbsent, 0.0, 3.0), testing::SizeIs(1));
  // at once, although another message came a moment ago
  EXPECT_THAT(told(news, kThere, 3.0, 30.0), ElementsAre("The tracker is there: connected."));
  EXPECT_EQ(told(news, kCut, 30.0, 30.1).size(), 1u);
  EXPECT_THAT(told(news, kAbsent, 30.1, 50.0), IsEmpty());
  EXPECT_THAT(told(news, kThere, 50.0, 70.0), ElementsAre("The tracker is back: connected."));
}

TEST(TrackerNews, ATrackerPresentFromTheStartIsReportedOnce) {
  TrackerNews news;
  EXPECT_THAT(told(news, kThere, 0.1, 60.0), ElementsAre("The tracker is there: connected."));
}

TEST(TrackerNews, ATrackerThatComesAndGoesIsReportedEveryFewSecondsAtMost) {
  TrackerNews news;
  std::vector<std::string> all = told(news, kThere, 0.0, 1.0);
  for (double t = 1.0; t < 61.0; t += 0.4) {
    for (const auto& sentence : told(news, kCut, t, t + 0.2)) all.push_back(sentence);
    for (const auto& sentence : told(news, kThere, t + 0.2, t + 0.4)) all.push_back(sentence);
  }
  EXPECT_GE(all.size(), 5u);
  EXPECT_LE(all.size(), 14u);
}

TEST(TrackerNews, AServiceWithoutATrackerIsReported) {
  TrackerNews news;
  EXPECT_THAT(told(news, kMute, 0.0, 60.0),
              ElementsAre("The tracker is there: connected.",
                          StartsWith("The tracker sends no frame: connected.")));
  EXPECT_THAT(told(news, kThere, 60.0, 70.0), testing::SizeIs(1));
}

}  // namespace
}  // namespace prostm
