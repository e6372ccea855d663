// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints: what comes back, what is refused, what stays after a failure.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "framework/io/posix_file.hpp"
#include "sample_state.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {

namespace {

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::file);
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST(GlobalOrder, RefusesIdsOutOfRangeOnAllRanks) {
  const Communicator& comm = testing::communicator();
  std::vector<GlobalId> ids;
  if (comm.rank() == comm.size() - 1) ids.push_back(5);
  EXPECT_TRUE(contains(message_of([&] { GlobalOrder(comm, ids, 5); }), "id 5 is not in 0 .. 4"));
}

TEST(GlobalOrder, FewerIdsThanRanks) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_few");
  const std::vector<GlobalId> ids = testing::scattered_ids(comm, 2);
  const GlobalOrder order(comm, ids, 2);
  {
    CheckpointWriter file(comm, folder + "/few.h5");
    file.array("x", order, testing::samples(ids, 4, 0), 4);
    file.finish();
  }
  std::vector<double> values(ids.size() * 4);
  CheckpointReader(comm, folder + "/few.h5").array("x", order, values, 4);
  EXPECT_TRUE(testing::same_bits(values, testing::samples(ids, 4, 0)));
}

TEST(Checkpoint, HoldsTextOfMoreThanAnAttribute) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_text");
  const std::string text(200'000, 'x');
  {
    CheckpointWriter file(comm, folder + "/text.h5");
    file.text("scene", text);
    file.finish();
  }
  EXPECT_EQ(CheckpointReader(comm, folder + "/text.h5").text("scene"), text);
}

TEST(Checkpoint, ValuesOfTheFirstRankCount) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_root");
  {
    CheckpointWriter file(comm, folder + "/root.h5");
    file.integer("rank", comm.rank());
    file.finish();
  }
  EXPECT_EQ(CheckpointReader(comm, folder + "/root.h5").integer("rank"), 0);
}

TEST(Checkpoint, SaysWhatItHas) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_has") + "/a.h5";
  testing::write_sample(comm, path);
  const CheckpointReader file(comm, path);
  for (const char* name : {"time", "step", "scene", "mechanics/stress"}) EXPECT_TRUE(file.has(name)) << name;
  for (const char* name : {"tim", "mechanics/eqps", "contact/gap/normal", "scene/time", "thermal/nothing"})
    EXPECT_FALSE(file.has(name)) << name;
}

TEST(Checkpoint, RefusesWhatDoesNotFit) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_fit") + "/a.h5";
  testing::write_sample(comm, path);
  const CheckpointReader file(comm, path);
  const std::vector<GlobalId> ids = testing::scattered_ids(comm, testing::sample_nodes);
  const GlobalOrder order(comm, ids, testing::sample_nodes), smaller(comm, {}, 10);
  std::vector<double> values(ids.size() * 3);
  EXPECT_TRUE(contains(message_of([&] { file.scalar("tim"); }), "has no value 'tim'"));
  EXPECT_TRUE(contains(message_of([&] { file.scalar("step"); }), "value 'step' cannot be read"));
  EXPECT_TRUE(contains(message_of([&] { file.text("nosuch"); }), "has no dataset 'nosuch'"));
  EXPECT_TRUE(contains(message_of([&] { file.text("mechanics/stress"); }), "is not a text"));
  EXPECT_TRUE(contains(message_of([&] { file.text("mechanics"); }), "cannot be opened"));
  EXPECT_TRUE(contains(message_of([&] { file.array("scene", order, values, 3); }), "not a table"));
  EXPECT_TRUE(contains(message_of([&] { file.array("mechanics/displacement", smaller, {}, 3); }),
                       "is 1237 x 3, expected 10 x 3"));
  EXPECT_TRUE(
      contains(message_of([&] { file.array("mechanics/stress", order, values, 3); }), "'mechanics/stress' is 911 x 6"));
  if (comm.rank() == 0) values.pop_back();
  EXPECT_TRUE(contains(message_of([&] { file.array("mechanics/displacement", order, values, 3); }), "room for"));
}

TEST(Checkpoint, RefusesToWriteRowsTwiceOrNotAtAll) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_twice");
  CheckpointWriter file(comm, folder + "/a.h5");
  const std::vector<GlobalId> repeated = comm.rank() == 0 ? std::vector<GlobalId>{0, 1, 1} : std::vector<GlobalId>{};
  const GlobalOrder order(comm, repeated, 3);
  const std::vector<double> values(repeated.size());
  EXPECT_TRUE(
      contains(message_of([&] { file.array("x", order, values, 1); }), "not every id is given by exactly one rank"));
  EXPECT_TRUE(contains(message_of([&] {
                         file.scalar("time", 1);
                         file.scalar("time", 2);
                       }),
                       "time"));
}

TEST(Checkpoint, OldFileStandsUntilTheNewOneIsWhole) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_old");
  const std::string path = folder + "/final.h5";
  for (const int version : {1, 2}) {
    CheckpointWriter file(comm, path);
    file.integer("version", version);
    if (version == 1) file.finish();
  }
  EXPECT_EQ(CheckpointReader(comm, path).integer("version"), 1);
  comm.barrier();
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(Checkpoint, IgnoresWhatAKilledWriterLeft) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_left");
  comm.vote_on_root([&] { std::ofstream(folder + "/a.h5.part") << std::string(100'000, 'x'); });
  testing::write_sample(comm, folder + "/a.h5");
  testing::write_sample(comm, folder + "/b.h5");
  comm.vote_on_root([&] { EXPECT_EQ(read_text(folder + "/a.h5"), read_text(folder + "/b.h5")); });
}

TEST(Checkpoint, SaysWhyAFileCannotBeMade) {
  const Communicator& comm = testing::communicator();
  const std::string said = message_of([&] { CheckpointWriter(comm, "no-such-folder/a.h5"); });
  EXPECT_TRUE(contains(said, "no-such-folder/a.h5.part: cannot be written: No such file or directory")) << said;
}

// A limit on the size of files stands for a full disk: the write fails in the middle, on whichever rank does it.
TEST(Checkpoint, FullDiskIsAnErrorOnAllRanksAndTheOldFileStands) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_full") + "/a.h5";
  testing::write_sample(comm, path);
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit small { 300'000, before.rlim_max };
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::vector<GlobalId> ids = testing::scattered_ids(comm, 100'000);
  const std::string said = message_of([&] {
    const GlobalOrder order(comm, ids, 100'000);
    CheckpointWriter file(comm, path);
    file.array("big", order, testing::samples(ids, 3, 0), 3);
    file.finish();
  });
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(said, path + ".part: cannot be written: File too large");
  EXPECT_EQ(CheckpointReader(comm, path).scalar("time"), 1.0 / 3.0);
}

}  // namespace tenon
