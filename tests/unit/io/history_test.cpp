// SPDX-License-Identifier: BSD-3-Clause
// history.csv: rows, restart, torn lines, errors.
#include "framework/io/history.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "framework/io/posix_file.hpp"
#include "sample_state.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {

namespace {

const std::vector<std::string> columns{"time", "step", "kinetic_energy"};

std::string content(const Communicator& comm, const std::string& path) {
  std::string text;
  comm.vote_on_root([&] { text = read_text(path); });
  comm.broadcast(text);
  return text;
}

void put(const Communicator& comm, const std::string& path, const std::string& text) {
  comm.vote_on_root([&] { std::ofstream(path) << text; });
}

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::file);
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST(History, WritesSeventeenDigitsAndWholeNumbers) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_history_rows") + "/history.csv";
  History history(comm, path, columns, -1);
  history.row(std::vector{0.1, 123456789.0, 1e300});
  history.row(std::vector{1e-7, 1e15, std::numeric_limits<double>::quiet_NaN()});
  // Without a flush: a kill now would lose nothing.
  EXPECT_EQ(content(comm, path),
            "time,step,kinetic_energy\n0.10000000000000001,123456789,1.0000000000000001e+300\n"
            "9.9999999999999995e-08,1000000000000000,nan\n");
  history.flush();
}

TEST(History, NewRunReplacesTheOldFile) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_history_new") + "/history.csv";
  put(comm, path, "something,else\n1,2\n");
  const History history(comm, path, columns, -1);
  EXPECT_EQ(content(comm, path), "time,step,kinetic_energy\n");
}

TEST(History, RestartCutsLaterRows) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_history_cut") + "/history.csv";
  put(comm, path, "time,step,kinetic_energy\n0,0,1\n0.5,5,2\n1,10,nan\n1.5,15,-inf\n2,20,3\n");
  History history(comm, path, columns, 10);
  history.row(std::vector{1.25, 12.0, 4.0});
  EXPECT_EQ(content(comm, path), "time,step,kinetic_energy\n0,0,1\n0.5,5,2\n1,10,nan\n1.25,12,4\n");
}

TEST(History, RestartDropsATornLine) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_history_torn") + "/history.csv";
  const std::string whole = "time,step,kinetic_energy\n0,0,1\n0.5,5,2\n1,10,3\n";
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    put(comm, path, whole.substr(0, cut));
    const History history(comm, path, columns, 100);
    const std::string text = content(comm, path);
    ASSERT_TRUE(whole.starts_with(text) && text.ends_with('\n')) << cut;
    ASSERT_LT(std::max(cut, std::size_t{25}) - text.size(), 9u) << cut;
  }
  put(comm, path, "time,step,kinetic_energy\n0,0,1\n0.5,5\n1,10,3\n");
  const History history(comm, path, columns, 100);
  EXPECT_EQ(content(comm, path), "time,step,kinetic_energy\n0,0,1\n");
}

TEST(History, RestartWithoutAFileStartsOne) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_history_none") + "/history.csv";
  const History history(comm, path, columns, 10);
  EXPECT_EQ(content(comm, path), "time,step,kinetic_energy\n");
}

TEST(History, RefusesOtherColumnsAndRepeatedOnes) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_history_columns") + "/history.csv";
  put(comm, path, "time,step,internal_energy\n0,0,1\n");
  EXPECT_NE(message_of([&] { History(comm, path, columns, 10); }).find("its columns are not those of this run"),
            std::string::npos);
  EXPECT_EQ(content(comm, path), "time,step,internal_energy\n0,0,1\n");
  EXPECT_EQ(message_of([&] { History(comm, path, {"time", "time"}, -1); }), "history: column 'time' stands twice");
  EXPECT_NE(message_of([&] { History(comm, path, {"a,b"}, -1); }).find("cannot be the name"), std::string::npos);
  EXPECT_NE(message_of([&] { History(comm, "no-such-folder/history.csv", columns, -1); }).find("No such file"),
            std::string::npos);
}

TEST(History, FullDiskShowsAtTheFlushOnAllRanks) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_history_full") + "/history.csv";
  History history(comm, path, columns, -1);
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit small { 200, before.rlim_max };
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  for (int i = 0; i < 100; ++i) history.row(std::vector{1.0 * i, 1.0 * i, 1.0 / 3.0});
  const std::string said = message_of([&] { history.flush(); });
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(said, path + ": cannot be written: File too large");
}

}  // namespace tenon
