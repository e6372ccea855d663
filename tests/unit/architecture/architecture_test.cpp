// SPDX-License-Identifier: BSD-3-Clause
// The direction of the architecture, read from the includes: apps -> components, transfer -> framework.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path root = TENON_SOURCE_DIR;

/// What each room may include besides itself.
const std::map<std::string, std::set<std::string>> allowed = [] {
  std::map<std::string, std::set<std::string>> rooms;
  rooms["framework/base"] = {};
  rooms["framework/comm"] = {"framework/base"};
  rooms["framework/decomposition"] = {"framework/base", "framework/comm"};
  rooms["framework/search"] = {"framework/base", "framework/comm", "framework/decomposition"};
  const auto below = [&](const std::string& room, const std::string& last) {
    rooms[room] = rooms[last];
    rooms[room].insert(last);
  };
  below("framework/mesh", "framework/search");
  below("framework/fields", "framework/mesh");
  below("framework/mesh_files", "framework/fields");
  below("framework/io", "framework/fields");
  below("framework/simulation", "framework/io");
  rooms["framework/scene"] = {"framework/base"};
  below("transfer", "framework/simulation");
  rooms["components/materials"] = {"framework/base", "framework/scene"};
  rooms["components/contact_geometry"] = {"framework/base"};
  below("components/mechanics", "framework/simulation");
  rooms["components/mechanics"].insert({"components/materials", "framework/scene"});
  rooms["components/thermal"] = rooms["components/mechanics"];
  rooms["components/sph"] = rooms["components/mechanics"];
  below("components/contact", "framework/simulation");
  rooms["components/contact"].insert({"components/contact_geometry", "framework/scene"});
  return rooms;
}();

std::string room_of(const std::string& path) {
  for (const auto& [room, unused] : allowed)
    if (path.rfind(room + "/", 0) == 0) return room;
  return "";
}

std::vector<fs::path> sources() {
  std::vector<fs::path> files;
  for (const char* const top : {"framework", "transfer", "components"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top))
      if (entry.path().extension() == ".hpp" || entry.path().extension() == ".cpp") files.push_back(entry.path());
  return files;
}

template <typename Visit>
void for_each_line(const fs::path& file, Visit&& visit) {
  std::ifstream text(file);
  int number = 0;
  for (std::string line; std::getline(text, line);) visit(line, ++number);
}

TEST(Architecture, EveryFileHasARoom) {
  ASSERT_GT(sources().size(), 50u);
  for (const fs::path& file : sources()) EXPECT_NE(room_of(fs::relative(file, root).string()), "") << file;
}

TEST(Architecture, IncludesPointOneWay) {
  for (const fs::path& file : sources()) {
    const std::string room = room_of(fs::relative(file, root).string());
    for_each_line(file, [&](const std::string& line, int number) {
      if (line.rfind("#include \"", 0) != 0) return;
      const std::string included = line.substr(10, line.find('"', 10) - 10), target = room_of(included);
      EXPECT_NE(target, "") << file << ":" << number << ": " << line << ": name the file by its path from the root";
      EXPECT_TRUE(target == room || allowed.at(room).contains(target)) << file << ":" << number << ": " << line;
    });
  }
}

TEST(Architecture, OnlyThreeRoomsSpeakMpi) {
  const std::set<std::string> speakers{"framework/comm", "framework/decomposition", "framework/io"};
  for (const fs::path& file : sources()) {
    if (speakers.contains(room_of(fs::relative(file, root).string()))) continue;
    for_each_line(file, [&](const std::string& line, int number) {
      EXPECT_EQ(line.find("MPI_"), std::string::npos) << file << ":" << number;
      EXPECT_EQ(line.find("mpi.h"), std::string::npos) << file << ":" << number;
    });
  }
}

}  // namespace
