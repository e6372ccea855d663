// SPDX-License-Identifier: BSD-3-Clause
// Gmsh files that are refused, and what the message says.
#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

struct Case {
  const char* name;
  std::string text;
  std::vector<const char*> words;
};

std::string msh(const std::string& format, const std::string& rest) {
  return "$MeshFormat\n" + format + "\n$EndMeshFormat\n" + rest;
}
std::string msh22(const std::string& nodes, const std::string& elements) {
  return msh("2.2 0 8", "$Nodes\n" + nodes + "$EndNodes\n$Elements\n" + elements + "$EndElements\n");
}
const std::string four = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
const std::string tet = "1\n1 4 2 0 1 1 2 3 4\n";

std::vector<Case> cases() {
  return {
      {"version_1", "$NOD\n1\n1 0 0 0\n$ENDNOD\n", {"version 1", "gmsh OLD.msh -save"}},
      {"version_3", msh("3 0 8", ""), {"line 2", "version 3. is not known", "4.1", "gmsh OLD.msh -save"}},
      {"version_4_2", msh("4.2 0 8", ""), {"version 4.2 is not known"}},
      {"binary_4_0", msh("4 1 8", ""), {"4.0", "text only", "gmsh OLD.msh -save"}},
      {"small_numbers", msh("4.1 0 4", ""), {"4 bytes"}},
      {"no_format", "$Nodes\n0\n$EndNodes\n", {"$MeshFormat"}},
      {"format_without_numbers", "$MeshFormat\nfour\n", {"line 2", "the version", "'four'"}},
      {"no_nodes", msh("2.2 0 8", "$Elements\n0\n$EndElements\n"), {"no section $Nodes"}},
      {"no_elements", msh("2.2 0 8", "$Nodes\n" + four + "$EndNodes\n"), {"no section $Elements"}},
      {"no_element", msh22(four, "0\n"), {"no volume or surface elements"}},
      {"lines_only", msh22(four, "1\n1 1 2 0 1 1 2\n"), {"only points and lines"}},
      {"unknown_node", msh22(four, "1\n1 4 2 0 1 1 2 3 5\n"), {"element 1", "node 5"}},
      {"node_twice", msh22("2\n1 0 0 0\n1 1 0 0\n", tet), {"node 1 is defined twice"}},
      {"nan", msh22("4\n1 0 0 nan\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", tet), {"node 1", "not finite"}},
      {"too_large", msh22("4\n1 0 0 1e999\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", tet), {"node 1", "not finite"}},
      {"second_order",
       msh22(four, "1\n1 18 2 0 1 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15\n"),
       {"line 13", "15-node prism", "Mesh.ElementOrder = 1"}},
      {"curved_surface",
       msh22("6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 .5 0 0\n5 .5 .5 0\n6 0 .5 0\n", "1\n7 9 2 0 1 1 2 3 4 5 6\n"),
       {"element 7", "second order", "Mesh.ElementOrder = 1"}},
      {"unknown_type", msh22(four, "1\n1 4242 2 0 1 1 2 3 4\n"), {"type 4242"}},
      {"negative_count", msh22("-4\n1 0 0 0\n", tet), {"impossible number of nodes -4"}},
      {"huge_count", msh22("999999999999\n1 0 0 0\n", tet), {"impossible number of nodes"}},
      {"count_of_many_digits", msh22("99999999999999999999999\n1 0 0 0\n", tet), {"whole number"}},
      {"too_few_nodes", msh22("3\n1 0 0 0\n2 1 0 0\n", tet), {"line 8", "expected a node number", "'$EndNodes'"}},
      {"too_many_nodes", msh22("1\n1 0 0 0\n2 1 0 0\n", tet), {"line 7", "expected $EndNodes", "'2'"}},
      {"negative_node", msh22("1\n-1 0 0 0\n", tet), {"impossible node tag -1"}},
      {"many_tags", msh22(four, "1\n1 4 2000000000 0 1 1 2 3 4\n"), {"impossible number of tags"}},
      {"partitioned_2",
       msh22(four, "2\n1 4 4 0 1 1 1 1 2 3 4\n2 4 4 0 1 1 2 1 2 3 4\n"),
       {"partitioned", "Unpartition"}},
      {"partitioned_4",
       msh("4.1 0 8", "$PartitionedEntities\n2\n$EndPartitionedEntities\n"),
       {"partitioned", "Unpartition"}},
      {"unnamed_group", msh("2.2 0 8", "$PhysicalNames\n1\n3 1 bar\n$EndPhysicalNames\n"), {"line 6", "double quotes"}},
      {"nodes_twice",
       msh("2.2 0 8", "$Nodes\n" + four + "$EndNodes\n$Nodes\n" + four + "$EndNodes\n"),
       {"a second $Nodes"}},
      {"text_after_end", msh22(four, tet) + "that is all", {"expected the start of a section"}},
      {"node_total", msh("4.1 0 8", "$Nodes\n1 4 1 4\n3 1 0 1\n1\n0 0 0\n$EndNodes\n"), {"found 1 nodes, expected 4"}},
      {"dimension", msh("4.1 0 8", "$Nodes\n1 4 1 4\n5 1 0 1\n1\n0 0 0\n$EndNodes\n"), {"dimension", "0 to 3"}},
      {"huge_block",
       msh("4.1 0 8", "$Nodes\n1 4 1 4\n3 1 0 9223372036854775807\n1\n0 0 0\n$EndNodes\n"),
       {"impossible number of nodes"}},
  };
}

class GmshRefusals : public FolderTest, public ::testing::WithParamInterface<Case> {};

TEST_P(GmshRefusals, SayWhatIsWrong) {
  const std::string file = write("mesh.msh", GetParam().text);
  const std::string message = refusal([&] { read_gmsh(file); });
  expect_mentions(message, {file.c_str()});
  for (const char* word : GetParam().words) expect_mentions(message, {word});
}

INSTANTIATE_TEST_SUITE_P(Cases, GmshRefusals, ::testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace tenon::testing
