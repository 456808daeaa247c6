#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "io/examples.hpp"
#include "io/random_field.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/io/recorder.hpp"
#include "support/full_disk.hpp"
#include "support/no_locks.hpp"

namespace prostm {
namespace {

using test::input_error;
using testing::HasSubstr;

HandFrame hand_at(double time) {
  HandFrame frame;
  frame.time = time;
  Hand hand;
  hand.id = 7;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    hand.position[j] = Vec3(0.001 * static_cast<double>(j), 0.0, 0.2);
    hand.orientation[j] = Quat::Identity();
    hand.radius[j] = 0.01;
    hand.velocity[j] = Vec3(0.1, 0.0, 0.0);
  }
  frame.hands.push_back(hand);
  return frame;
}

std::vector<TargetFrame> random_frames(int count) {
  Random random(21);
  std::vector<TargetFrame> frames;
  for (int i = 0; i < count; ++i) {
    TargetFrame frame;
    frame.time = 0.02 * i;
    const int patches = random.below(3);
    for (int p = 0; p < patches; ++p) frame.patches.push_back(test::random_field(random));
    frames.push_back(frame);
  }
  return frames;
}

void expect_same(const TargetFrame& a, const TargetFrame& b) {
  EXPECT_EQ(a.time, b.time);
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t p = 0; p < a.patches.size(); ++p) {
    test::expect_same_raster(a.patches[p], b.patches[p]);
    EXPECT_EQ(a.patches[p].X_DP.matrix(), b.patches[p].X_DP.matrix());
  }
}

RecordedPlan some_plan() {
  RecordedPlan made;
  made.plan = test::triangle_plan();
  made.plan.loop = 20e-3;
  made.stats.total = 3e-3;
  made.stats.leaves = 5;
  made.stats.cost = 0.25;
  made.full_scale_pressure = 0.7;
  made.sigma = {8e-3, 9e-3};
  return made;
}

GateResult some_result() {
  GateResult said;
  said.share = 0.4;
  said.finding = {GateProblem::Beside, 0.05, 0.025, Vec2(0.04, -0.03)};
  said.shape.maxima.push_back({Vec2(0.01, -0.02), 0.09});
  said.shape.maxima.push_back({Vec2(-0.03, 0.02), 0.08});
  said.shape.largest = 0.09;
  said.shape.balance = 0.08 / 0.09;
  said.shape.saddle = 0.6;
  said.shape.least_spacing = said.shape.most_spacing = 0.0566;
  said.shape.area = 52e-4;
  said.shape.force = 0.4e-3;
  return said;
}

std::string record(const std::string& path, const std::vector<TargetFrame>& frames) {
  Recorder recorder(path, {});
  recorder.set_attribute("scene", "one-plume");
  const RecordedPlan plan = some_plan();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool planned = i % 2 == 1;
    std::optional<GateResult> gate;
    if (planned) gate = some_result();
    recorder.append(frames[i], hand_at(frames[i].time), planned ? &plan : nullptr, gate);
  }
  recorder.set_attribute("scene", "four-plumes");
  recorder.close();
  return path;
}

TEST(Recording, ReadsBackWhatWasWritten) {
  const test::TemporaryFolder folder;
  const std::vector<TargetFrame> frames = random_frames(200);
  const RecordingReader reader(record(folder.file("r.h5"), frames));
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_EQ(reader.attribute("scene"), "four-plumes");
  ASSERT_EQ(reader.frames(), 200);
  for (int i = 199; i >= 0; --i) expect_same(reader.frame(i), frames[static_cast<std::size_t>(i)]);
}

TEST(Recording, ReadsThePlanOfAFrame) {
  const test::TemporaryFolder folder;
  std::vector<TargetFrame> frames = random_frames(4);
  Random random(3);
  for (TargetFrame& frame : frames) frame.patches.assign(1, test::random_field(random));
  const RecordingReader reader(record(folder.file("r.h5"), frames));
  EXPECT_FALSE(reader.plan(0));
  const std::optional<RecordedPlan> read = reader.plan(3);
  ASSERT_TRUE(read);
  const RecordedPlan made = some_plan();
  ASSERT_EQ(read->plan.paths.size(), 1u);
  EXPECT_TRUE(read->plan.foci.empty());
  const FocalPath &path = read->plan.paths[0], &expected = made.plan.paths[0];
  EXPECT_EQ(path.patch, expected.patch);
  EXPECT_EQ(path.points, expected.points);
  EXPECT_EQ(path.pressure, expected.pressure);
  EXPECT_EQ(path.length, expected.length);
  EXPECT_EQ(path.speed, expected.speed);
  EXPECT_EQ(path.period, expected.period);
  EXPECT_EQ(read->plan.loop, 20e-3);
  for (const Quantity<PlanStats>& number : quantities<PlanStats>())
    EXPECT_EQ(value_of(number, read->stats), value_of(number, made.stats)) << number.name;
  EXPECT_EQ(read->full_scale_pressure, 0.7);
  EXPECT_EQ(read->sigma[0], 8e-3);
  EXPECT_EQ(read->sigma[1], 0.0);  // the frame has one patch
  EXPECT_THAT(input_error([&] { static_cast<void>(reader.plan(4)); }),
              HasSubstr("no frame 4; it has 4 frames"));
}

TEST(Recording, ReadsTheVerdictsOfTheGate) {
  const test::TemporaryFolder folder;
  const RecordingReader reader(record(folder.file("r.h5"), random_frames(4)));
  EXPECT_FALSE(reader.gate(0));
  const std::optional<GateResult> read = reader.gate(3);
  ASSERT_TRUE(read);
  const GateResult said = some_result();
  EXPECT_EQ(read->pass, said.pass);
  EXPECT_EQ(read->share, said.share);
  EXPECT_EQ(read->finding.problem, said.finding.problem);
  EXPECT_EQ(sentence(*read), sentence(said));
  ASSERT_EQ(read->shape.count(), 2);
  EXPECT_EQ(read->shape.maxima[1].position, said.shape.maxima[1].position);
  EXPECT_EQ(read->shape.maxima[1].pressure, 0.08);
  for (const Quantity<FieldShape>& number : quantities<FieldShape>())
    EXPECT_EQ(value_of(number, read->shape), value_of(number, said.shape)) << number.name;
  EXPECT_THAT(input_error([&] { static_cast<void>(reader.gate(4)); }), HasSubstr("no frame 4"));
}

TEST(Recording, ReadsThePlanOfFoci) {
  const test::TemporaryFolder folder;
  Random random(4);
  TargetFrame frame;
  frame.patches.assign(2, test::random_field(random));
  RecordedPlan made = some_plan();
  made.plan.clear();
  made.plan.foci.push_back({1, Vec2(0.01, -0.02), 3.5, 0.625});
  const std::string path = folder.file("r.h5");
  Recorder recorder(path, {});
  recorder.append(frame, hand_at(0.0), &made);
  made.plan.foci[0].patch = 2;  // a patch that the frame does not have
  recorder.append(frame, hand_at(0.02), &made);
  recorder.close();
  const RecordingReader reader(path);
  const std::optional<RecordedPlan> read = reader.plan(0);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->plan.paths.empty());
  EXPECT_EQ(read->plan.loop, 0.0);
  ASSERT_EQ(read->plan.foci.size(), 1u);
  EXPECT_EQ(read->plan.foci[0].patch, 1);
  EXPECT_EQ(read->plan.foci[0].position, Vec2(0.01, -0.02));
  EXPECT_EQ(read->plan.foci[0].pressure, 3.5);
  EXPECT_EQ(read->plan.foci[0].phase, 0.625);
  EXPECT_EQ(read->sigma, made.sigma);
  EXPECT_THAT(input_error([&] { static_cast<void>(reader.plan(1)); }), HasSubstr("is damaged"));
}

TEST(Recording, ReportsThatItIsStillBeingWritten) {
  const test::TemporaryFolder folder;
  const std::string path = record(folder.file("r.h5"), random_frames(3));
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(fd, LOCK_EX | LOCK_NB), 0);  // as HDF5 does for writing
  EXPECT_THAT(input_error([&] { const RecordingReader reader(path); }),
              HasSubstr("is open for writing in another program"));
  ::close(fd);
  EXPECT_EQ(RecordingReader(path).frames(), 3);
}

TEST(Recording, WorksOnAFileSystemWithoutLocks) {
  const test::TemporaryFolder folder;
  const std::vector<TargetFrame> frames = random_frames(3);
  for (const int error : {ENOLCK, ENOSYS, EOPNOTSUPP, EINVAL}) {
    const test::NoLocks none(error);
    const RecordingReader reader(record(folder.file("r.h5"), frames));
    ASSERT_EQ(reader.frames(), 3);
    expect_same(reader.frame(1), frames[1]);
    write_file(folder.file("text.h5"), "hello");
    EXPECT_THAT(input_error([&] { const RecordingReader other(folder.file("text.h5")); }),
                HasSubstr("is not an HDF5 file"));
  }
}

TEST(Recording, StoresWeightsOnlyForPatchesThatHaveThem) {
  const test::TemporaryFolder folder;
  const auto has_table = [](const std::string& path) {
    return read_file(path).find("weight") != std::string::npos;
  };
  std::vector<TargetFrame> frames = random_frames(30);
  for (TargetFrame& frame : frames) {
    for (TargetField& field : frame.patches) field.weight.clear();
  }
  EXPECT_FALSE(has_table(record(folder.file("none.h5"), frames)));

  // weights from a patch in the middle on
  TargetFrame late = frames.back();
  late.patches.assign(1, frames[0].patches.empty() ? TargetField() : frames[0].patches[0]);
  late.patches[0].resize(2, 2);
  late.patches[0].cell = 5e-3;
  late.patches[0].skin = {1, 1, 0, 1};
  late.patches[0].weight = {0.0, 3.0, 0.0, 0.25};
  frames.insert(frames.begin() + 20, late);
  const std::string path = record(folder.file("late.h5"), frames);
  EXPECT_TRUE(has_table(path));
  const RecordingReader reader(path);
  for (int i = 0; i < reader.frames(); ++i) {
    expect_same(reader.frame(i), frames[static_cast<std::size_t>(i)]);
  }

  // invalid weights are rejected only with their own frame
  frames[20].patches[0].weight = {0.0, -3.0, 0.0, 1.0};
  const RecordingReader negative(record(folder.file("negative.h5"), frames));
  EXPECT_NO_THROW(static_cast<void>(negative.frame(19)));
  EXPECT_THAT(
      input_error([&] { static_cast<void>(negative.frame(20)); }),
      HasSubstr("negative.h5, frame 20: weight = -3 at row 0, column 1 must be at least 0"));
  frames[20].patches[0].weight = {0.0, 0.0, 1.0, 0.0};
  const RecordingReader zero(record(folder.file("zero.h5"), frames));
  EXPECT_THAT(input_error([&] { static_cast<void>(zero.frame(20)); }),
              HasSubstr("frame 20: weights that are 0 on all skin"));
}

TEST(Recording, StoresPartsOfThePressureOnlyForPatchesThatHaveThem) {
  const test::TemporaryFolder folder;
  std::vector<TargetFrame> frames = random_frames(30);
  EXPECT_EQ(read_file(record(folder.file("none.h5"), frames)).find("movement"), std::string::npos);

  // parts from a patch in the middle on
  TargetFrame late = frames.back();
  late.patches.assign(1, TargetField());
  TargetField& patch = late.patches[0];
  patch.resize(2, 2);
  patch.cell = 5e-3;
  patch.skin = {1, 1, 0, 1};
  patch.smoke = {0.25, -0.5, 0.0, 0.0};
  patch.movement = {-0.125, 1.0, 0.0, 2.0};
  frames.insert(frames.begin() + 20, late);
  const RecordingReader reader(record(folder.file("late.h5"), frames));
  for (int i = 0; i < reader.frames(); ++i) {
    const TargetFrame read = reader.frame(i);
    expect_same(read, frames[static_cast<std::size_t>(i)]);
    for (std::size_t p = 0; p < read.patches.size(); ++p) {
      const TargetField& written = frames[static_cast<std::size_t>(i)].patches[p];
      EXPECT_EQ(read.patches[p].smoke, written.smoke);
      EXPECT_EQ(read.patches[p].movement, written.movement);
    }
  }

  // invalid parts are rejected only with their own frame
  frames[20].patches[0].movement[3] = std::numeric_limits<double>::infinity();
  const RecordingReader endless(record(folder.file("endless.h5"), frames));
  EXPECT_NO_THROW(static_cast<void>(endless.frame(19)));
  EXPECT_THAT(input_error([&] { static_cast<void>(endless.frame(20)); }),
              HasSubstr("endless.h5, frame 20: movement = inf at row 1, column 1 must be finite"));
  frames[20].patches[0].movement.clear();
  const RecordingReader lone(record(folder.file("lone.h5"), frames));
  EXPECT_THAT(input_error([&] { static_cast<void>(lone.frame(20)); }),
              HasSubstr("must have as many values of each part of its pressure or none"));
}

TEST(Recording, MayBeEmpty) {
  const test::TemporaryFolder folder;
  const RecordingReader reader(record(folder.file("r.h5"), {}));
  EXPECT_EQ(reader.frames(), 0);
  EXPECT_THAT(input_error([&] { static_cast<void>(reader.frame(0)); }),
              HasSubstr("no frame 0; it has 0 frames"));
}

TEST(Recording, ConvertsTheHeavierPatchToAField) {
  const test::TemporaryFolder folder;
  Random random(2);
  TargetFrame frame;
  frame.patches.push_back(test::random_field(random));
  frame.patches.push_back(test::random_field(random));
  frame.patches[0].resize(3, 3);
  frame.patches[1].skin[0] = 1;
  frame.patches[1].pressure[0] = 7.0;
  TargetFrame empty;
  empty.time = 1.0;
  const std::string path = record(folder.file("r.h5"), {frame, empty});
  EXPECT_EQ(read_field(path).pressure, frame.patches[1].pressure);
  FieldFileOptions options;
  options.frame = 1;
  EXPECT_THAT(input_error([&] { read_field(path, options); }), HasSubstr("frame 1 holds no hand"));
  options.frame = 2;
  EXPECT_THAT(input_error([&] { read_field(path, options); }),
              HasSubstr("no frame 2; it has 2 frames"));
  options.frame = -1;
  EXPECT_THAT(input_error([&] { read_field(path, options); }), HasSubstr("no frame -1"));
}

TEST(Recording, KeepsFlushedFramesWhenItsWriterDies) {
  const test::TemporaryFolder folder;
  const std::vector<TargetFrame> frames = random_frames(160);  // 3.2 s
  const std::string path = folder.file("r.h5"), copy = folder.file("copy.h5");
  Recorder recorder(path, {});
  for (const TargetFrame& frame : frames) recorder.append(frame, hand_at(frame.time), nullptr);
  EXPECT_FALSE(std::filesystem::exists(path));
  std::filesystem::copy_file(path + ".part.h5", copy);
  const RecordingReader reader(copy);
  ASSERT_GE(reader.frames(), 150);  // all but the last second
  for (int i = 0; i < 150; ++i) expect_same(reader.frame(i), frames[static_cast<std::size_t>(i)]);
}

TEST(Recording, ReplacesAnOlderFileOnlyWhenComplete) {
  const test::TemporaryFolder folder;
  const std::string path = record(folder.file("r.h5"), random_frames(3));
  {
    Recorder recorder(path, {});
    EXPECT_EQ(RecordingReader(path).frames(), 3);
  }
  EXPECT_EQ(RecordingReader(path).frames(), 0);
}

TEST(Recording, RejectsOtherFiles) {
  const test::TemporaryFolder folder;
  const auto sentence = [](const std::string& path) {
    return input_error([&] { const RecordingReader reader(path); });
  };
  EXPECT_THAT(sentence(folder.file("none.h5")), HasSubstr("cannot be read"));
  EXPECT_THAT(sentence(folder.file("")), HasSubstr("is a folder"));
  write_file(folder.file("text.h5"), "hello");
  EXPECT_THAT(sentence(folder.file("text.h5")), HasSubstr("is not an HDF5 file"));
  write_file(folder.file("picture.h5"), "\x89PNG\r\n\x1a\n");
  EXPECT_THAT(sentence(folder.file("picture.h5")), HasSubstr("is a PNG picture, not an HDF5 file"));

  // truncated at many lengths
  const std::string bytes = read_file(record(folder.file("r.h5"), random_frames(20)));
  for (std::size_t size = 1; size < bytes.size(); size += bytes.size() / 50) {
    write_file(folder.file("cut.h5"), std::string_view(bytes).substr(0, size));
    EXPECT_THAT(sentence(folder.file("cut.h5")), HasSubstr("must be a recording"));
  }
}

TEST(Recording, CannotBeWrittenWithoutAFolder) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("missing/r.h5");
  EXPECT_THAT(input_error([&] { const Recorder recorder(path, {}); }),
              AllOf(HasSubstr(path), HasSubstr("No such file")));
  EXPECT_THAT(input_error([&] { const Recorder recorder("/dev/full", {}); }),
              HasSubstr("not an ordinary file"));
  EXPECT_THAT(input_error([&] { const Recorder recorder(folder.file(""), {}); }),
              HasSubstr("is a folder"));
  EXPECT_THAT(input_error([&] { const Recorder recorder(folder.file("r.txt"), {}); }),
              HasSubstr("r.txt is not a name for a recording; it must end in .h5"));
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(Recording, ReportsAFullDiskAtAnyTime) {
  const std::vector<TargetFrame> frames = random_frames(300);
  const test::TemporaryFolder sizes;
  const auto whole = std::filesystem::file_size(record(sizes.file("r.h5"), frames));
  int kept = 0;
  for (int part = 0; part < 12; ++part) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("r.h5");
    std::string sentence;
    {
      const test::FullDisk disk(
          static_cast<rlim_t>(whole * static_cast<std::uintmax_t>(part) / 12));
      sentence = input_error([&] { record(path, frames); });
    }
    EXPECT_THAT(sentence, HasSubstr("cannot be written"));
    EXPECT_FALSE(std::filesystem::exists(path));

    // the remaining file can be opened, or does not exist
    if (std::filesystem::exists(path + ".part.h5")) {
      EXPECT_THAT(sentence, HasSubstr(".part.h5"));
      const RecordingReader reader(path + ".part.h5");
      for (int i = 0; i < reader.frames(); ++i)
        expect_same(reader.frame(i), frames[static_cast<std::size_t>(i)]);
      EXPECT_GE(reader.frames(), kept);
      kept = reader.frames();
    } else {
      EXPECT_EQ(folder.entries(), 0u);
      EXPECT_EQ(kept, 0);
    }
  }
  EXPECT_GT(kept, 200);  // out of 300: those flushed before the disk was full
}

}  // namespace
}  // namespace prostm
