// SPDX-License-Identifier: BSD-3-Clause
// The same small mesh in every format of Gmsh that is read.
#include <algorithm>
#include <cstdio>
#include <cstring>

#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

/// Writes numbers as text, or as bytes.
class Emitter {
 public:
  explicit Emitter(const GmshFormat& format) : format_(format) {}
  void text(const std::string& t) { out += t; }
  void i(std::initializer_list<std::int32_t> values) { all(values); }
  void n(std::initializer_list<std::int64_t> values) { all(values); }
  void x(std::initializer_list<double> values) { all(values); }
  void line() { out += format_.binary ? "" : "\n"; }
  std::string out;

 private:
  template <class T>
  void all(std::initializer_list<T> values) {
    for (const T v : values) add(v);
  }
  template <class T>
  void add(T value) {
    if (!format_.binary) {
      char buffer[40];
      std::snprintf(buffer, sizeof buffer, "%.17g ", static_cast<double>(value));
      out += buffer;
      return;
    }
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (format_.swapped) std::reverse(raw, raw + sizeof(T));
    out.append(raw, sizeof(T));
  }
  GmshFormat format_;
};

struct Node {
  std::int32_t tag;
  double x, y, z;
};
constexpr Node nodes[] = {{50, 1, 1, 1}, {10, 0, 0, 0}, {20, 1, 0, 0}, {90, 9, 9, 9}, {30, 0, 1, 0}, {40, 0, 0, 1}};

struct Element {
  std::int32_t tag, dimension, entity, type, group;
  std::vector<std::int32_t> nodes;
};
const std::vector<Element>& elements() {
  static const std::vector<Element> all{{1, 0, 1, 15, 5, {50}},
                                        {2, 0, 2, 15, 6, {90}},
                                        {3, 1, 1, 1, 4, {10, 20}},
                                        {4, 2, 1, 2, 1, {20, 30, 40}},
                                        {5, 2, 2, 2, 2, {10, 30, 20}},
                                        {6, 3, 1, 4, 1, {10, 20, 30, 40}},
                                        {17, 3, 2, 4, 2, {20, 30, 40, 50}}};
  return all;
}

void emit_format(Emitter& e, const GmshFormat& f) {
  char line[40];
  std::snprintf(line, sizeof line, "$MeshFormat\n%.2g %d 8\n", f.version, f.binary ? 1 : 0);
  e.text(line);
  if (f.binary) e.i({1}), e.text("\n");
  e.text("$EndMeshFormat\n$PhysicalNames\n7\n0 5 \"tip\"\n0 6 \"away\"\n1 4 \"edge\"\n2 1 \"middle\"\n2 2 \"outer\"\n");
  e.text("3 1 \"left\"\n3 2 \"right\"\n$EndPhysicalNames\n");
}

void emit_2(Emitter& e, bool binary) {
  e.text("$Nodes\n6\n");
  for (const Node& n : nodes) e.i({n.tag}), e.x({n.x, n.y, n.z}), e.line();
  e.text(binary ? "\n$EndNodes\n$Elements\n7\n" : "$EndNodes\n$Elements\n7\n");
  for (const Element& element : elements()) {
    if (binary) e.i({element.type, 1, 2});
    e.i({element.tag});
    if (!binary) e.i({element.type, 2});
    e.i({element.group, element.entity});
    for (const std::int32_t n : element.nodes) e.i({n});
    e.line();
  }
  e.text(binary ? "\n$EndElements\n" : "$EndElements\n");
}

void emit_entities(Emitter& e, bool old) {
  e.text("$Entities\n");
  e.n({2, 1, 2, 2});
  e.line();
  for (const Element& element : elements()) {
    e.i({element.entity});
    e.x({0, 0, 0});
    if (element.dimension > 0 || old) e.x({1, 1, 1});
    e.n({1});
    e.i({element.group});
    if (element.dimension > 0) e.n({0});
    e.line();
  }
  e.text("\n$EndEntities\n");
}

void emit_4(Emitter& e, bool old) {
  emit_entities(e, old);
  e.text("$Nodes\n");
  e.n({1, 6});
  if (!old) e.n({10, 90});
  e.line();
  e.i(old ? std::initializer_list<std::int32_t>{1, 3, 0} : std::initializer_list<std::int32_t>{3, 1, 0});
  e.n({6});
  e.line();
  if (!old)
    for (const Node& n : nodes) e.n({n.tag}), e.line();
  for (const Node& n : nodes) {
    if (old) e.i({n.tag});
    e.x({n.x, n.y, n.z});
    e.line();
  }
  e.text("\n$EndNodes\n$Elements\n");
  e.n({7, 7});
  if (!old) e.n({1, 17});
  e.line();
  for (const Element& element : elements()) {
    e.i({old ? element.entity : element.dimension, old ? element.dimension : element.entity, element.type});
    e.n({1});
    e.line();
    e.n({element.tag});
    for (const std::int32_t n : element.nodes) e.n({n});
    e.line();
  }
  e.text("\n$EndElements\n");
}

}  // namespace

std::string two_tets(const GmshFormat& format) {
  Emitter e(format);
  emit_format(e, format);
  if (format.version < 4)
    emit_2(e, format.binary);
  else
    emit_4(e, format.version < 4.1);
  return e.out;
}

}  // namespace tenon::testing
