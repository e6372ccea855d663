// SPDX-License-Identifier: BSD-3-Clause
// Damaged and foreign checkpoints are refused with Error(file), or read right; never a crash.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>

#include "framework/io/checkpoint_format.hpp"
#include "framework/io/posix_file.hpp"
#include "sample_state.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {

namespace {

enum class Outcome { right, refused, wrong };

Outcome read_all(const Communicator& comm, const std::string& path) {
  try {
    const CheckpointReader file(comm, path);
    const std::vector<GlobalId> ids = testing::scattered_ids(comm, testing::sample_nodes);
    const GlobalOrder order(comm, ids, testing::sample_nodes);
    std::vector<double> values(ids.size() * 3);
    file.array("mechanics/displacement", order, values, 3);
    const bool right = testing::same_bits(values, testing::samples(ids, 3, 1)) && file.scalar("time") == 1.0 / 3.0;
    return comm.any(!right) ? Outcome::wrong : Outcome::right;
  } catch (const Error& error) {
    return error.code() == ExitCode::file ? Outcome::refused : Outcome::wrong;
  }
}

void put(const Communicator& comm, const std::string& path, const std::string& text) {
  comm.vote_on_root([&] { std::ofstream(path, std::ios::binary) << text; });
  comm.barrier();
}

std::string message_of_opening(const Communicator& comm, const std::string& path) {
  try {
    CheckpointReader(comm, path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// Makes the preamble fit the file again, as a writer would whose data went wrong before it was summed.
void reseal(const Communicator& comm, const std::string& path) {
  checkpoint_format::Preamble preamble;
  preamble.file_bytes = std::filesystem::file_size(path);
  preamble.file_checksum = checkpoint_format::file_checksum(comm, path, preamble.file_bytes);
  preamble.own_checksum = checkpoint_format::own_checksum(preamble);
  comm.vote_on_root([&] { PosixFile(path, O_WRONLY).write_at(&preamble, sizeof preamble, 0); });
}

}  // namespace

TEST(CheckpointDamage, FiveHundredRandomEdits) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_fuzz"), path = folder + "/a.h5";
  testing::write_sample(comm, path);
  std::string whole;
  comm.vote_on_root([&] { whole = read_text(path); });
  comm.broadcast(whole);
  int refused = 0;
  for (std::uint64_t trial = 0; trial < 500; ++trial) {
    const std::uint64_t draw = testing::scramble(trial), place = testing::scramble(draw) % whole.size();
    std::string edited = whole;
    switch (draw % 4) {
      case 0:
        edited[place] = static_cast<char>(edited[place] ^ (1 << (draw >> 32) % 8));
        break;
      case 1:
        edited[place % 4096] = static_cast<char>(edited[place % 4096] ^ (1 << (draw >> 32) % 8));
        break;
      case 2:
        edited.resize(place);
        break;
      default:
        edited.replace(place, 64, 64, static_cast<char>(draw >> 32));
        break;
    }
    put(comm, path, edited);
    const Outcome outcome = read_all(comm, path);
    ASSERT_NE(outcome, Outcome::wrong) << "trial " << trial;
    // Only edits of the unused part of the user block may pass.
    ASSERT_TRUE(outcome == Outcome::refused || edited.substr(512) == whole.substr(512)) << "trial " << trial;
    refused += outcome == Outcome::refused;
  }
  EXPECT_GT(refused, 400);
  put(comm, path, whole);
  EXPECT_EQ(read_all(comm, path), Outcome::right);
}

TEST(CheckpointDamage, NamesTheDataset) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_dataset") + "/a.h5";
  testing::write_sample(comm, path);
  const double sought = testing::sample(4, 1, 1);
  comm.vote_on_root([&] {
    std::string whole = read_text(path);
    const std::size_t at = whole.find(std::string(reinterpret_cast<const char*>(&sought), sizeof sought));
    ASSERT_NE(at, std::string::npos);
    whole[at] = static_cast<char>(whole[at] ^ 1);
    std::ofstream(path, std::ios::binary) << whole;
  });
  reseal(comm, path);
  const CheckpointReader file(comm, path);
  const std::vector<GlobalId> ids = testing::scattered_ids(comm, testing::sample_nodes);
  const GlobalOrder order(comm, ids, testing::sample_nodes);
  std::vector<double> values(ids.size() * 3);
  try {
    file.array("mechanics/displacement", order, values, 3);
    FAIL() << "damage not seen";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              path + ": dataset 'mechanics/displacement' is damaged (its checksum differs); use an older checkpoint");
  }
}

TEST(CheckpointDamage, ForeignFiles) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_foreign");
  put(comm, folder + "/empty.h5", "");
  put(comm, folder + "/text.h5", std::string(5000, 'x'));
  comm.vote_on_root([&] {
    const hid_t file = H5Fcreate((folder + "/other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(file);
  });
  for (const char* name : {"/empty.h5", "/text.h5", "/other.h5"})
    EXPECT_EQ(message_of_opening(comm, folder + name), folder + name + ": not a Tenon checkpoint");
  EXPECT_EQ(message_of_opening(comm, folder + "/none.h5"),
            folder + "/none.h5: cannot be opened: No such file or directory");
  EXPECT_EQ(message_of_opening(comm, folder), folder + ": cannot be read: Is a directory");
}

TEST(CheckpointDamage, OtherFormatVersion) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_version") + "/a.h5";
  testing::write_sample(comm, path);
  comm.vote_on_root([&] {
    checkpoint_format::Preamble preamble;
    PosixFile(path, O_RDONLY).read_at(&preamble, sizeof preamble, 0);
    preamble.version = 99;
    preamble.own_checksum = checkpoint_format::own_checksum(preamble);
    PosixFile(path, O_WRONLY).write_at(&preamble, sizeof preamble, 0);
  });
  EXPECT_EQ(message_of_opening(comm, path), path + ": checkpoint of format 99, this program reads format 1");
}

}  // namespace tenon
