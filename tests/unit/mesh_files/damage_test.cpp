// SPDX-License-Identifier: BSD-3-Clause
// Truncated and corrupted mesh files: each is read as a sound mesh or refused, and never crashes, hangs or takes much
// memory.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <random>

#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

// s. A child process with the HDF5 library may take 2 s of processor time, which is longer on a busy computer.
constexpr double slowest = 40;

class Damage : public FolderTest {
 protected:
  /// Whether the bytes are read; if so, as a sound mesh.
  bool is_read(const std::string& bytes) const {
    const std::string file = write("damaged", bytes);
    const auto start = std::chrono::steady_clock::now();
    bool read = false;
    try {
      expect_sound(read_mesh(file));
      read = true;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::file) << error.what();
    }
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), slowest);
    return read;
  }

  std::string exodus(bool hdf5) const {
    MeshData mesh = one_of_each_kind();
    if (hdf5) mesh.node_labels[0] = 5'000'000'000;
    write_exodus(mesh, path("whole.exo"));
    return bytes_of(path("whole.exo"));
  }

  /// Refused at every length that is a multiple of `step`, and at those near the end, but for the last `spare` bytes.
  void expect_refused_when_truncated(const std::string& whole, std::size_t step, std::size_t spare) const {
    ASSERT_TRUE(is_read(whole));
    for (std::size_t length = 0; length + spare<whole.size(); length += whole.size() - length> 20 ? step : 1)
      EXPECT_FALSE(is_read(whole.substr(0, length))) << length << " of " << whole.size();
  }

  /// Random damage of the kinds that real files suffer; returns how many files were refused.
  int damage_often(const std::string& whole, int times) const {
    std::mt19937 random(20261121);
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    int refused = 0;
    for (int t = 0; t < times; ++t) {
      std::string bytes = whole;
      // Headers stand at the beginning; there damage does most.
      const std::size_t at = below(t % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 4096));
      switch (t % 6) {
        case 0:
          bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
          break;
        case 1:
          bytes[at] = static_cast<char>(below(256));
          break;
        case 2:
          bytes.erase(at, 1 + below(40));
          break;
        case 3:
          bytes.insert(at, std::string(1 + below(40), static_cast<char>(below(256))));
          break;
        case 4:
          bytes.replace(at, 4, below(2) == 0 ? "\xff\xff\xff\xff" : "\x7f\xff\xff\xff");
          break;
        case 5:
          bytes.replace(at, 3, below(2) == 0 ? "-9 " : "1e9");
          break;
      }
      refused += is_read(bytes) ? 0 : 1;
    }
    return refused;
  }
};

/// TENON_FUZZ=N makes the tests N times as thorough.
int thoroughness() {
  const char* text = std::getenv("TENON_FUZZ");
  return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

const GmshFormat gmsh_formats[] = {{2.2}, {4.0}, {4.1}, {2.2, true}, {4.1, true}};

TEST_F(Damage, TruncatedClassicExodusIsRefused) {
  expect_refused_when_truncated(exodus(false), static_cast<std::size_t>(std::max(1, 23 / thoroughness())), 0);
}

TEST_F(Damage, TruncatedHdf5ExodusIsRefused) {
  expect_refused_when_truncated(exodus(true), static_cast<std::size_t>(std::max(1, 2003 / thoroughness())), 0);
}

TEST_F(Damage, TruncatedGmshIsRefused) {
  // Only the end of the last line may be missing.
  for (const GmshFormat& format : gmsh_formats)
    expect_refused_when_truncated(two_tets(format), static_cast<std::size_t>(std::max(1, 11 / thoroughness())), 1);
}

TEST_F(Damage, RandomDamageToClassicExodus) {
  const int times = 500 * thoroughness();
  EXPECT_GT(damage_often(exodus(false), times), times / 2);
}

TEST_F(Damage, RandomDamageToHdf5Exodus) {
  const int times = 60 * thoroughness();
  EXPECT_GT(damage_often(exodus(true), times), times / 4);
}

TEST_F(Damage, RandomDamageToGmsh) {
  const int times = 150 * thoroughness();
  for (const GmshFormat& format : gmsh_formats) EXPECT_GT(damage_often(two_tets(format), times), times / 3);
}

}  // namespace
}  // namespace tenon::testing
