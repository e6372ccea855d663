// SPDX-License-Identifier: BSD-3-Clause
// A validated scene: a tree of values in SI units, each of which knows its line.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/space_time_function.hpp"
#include "framework/base/time_function.hpp"
#include "framework/base/types.hpp"

namespace tenon::scene {

/// A place in a scene file, 1-based; line 0 means the command line (--set).
struct Where {
  std::string file;
  int line = 0;
  int column = 0;
};
/// "scene.yaml:12:5" or "--set key.path".
std::string to_string(const Where& where);

/// All complaints about one scene, reported together.
class Diagnostics {
 public:
  /// "FILE:LINE:COLUMN: message"; message says what was found, what was expected, and the nearest valid word.
  void error(const Where& where, const std::string& message);
  void warning(const Where& where, const std::string& message);
  bool any() const { return !errors_.empty(); }
  const std::vector<std::string>& errors() const { return errors_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Throws Error(usage) with all errors in the order of their lines, if there are any.
  void throw_if_any() const;

 private:
  struct Entry {
    Where where;
    std::string text;
  };
  std::vector<Entry> entries_;
  std::vector<std::string> errors_, warnings_;
};

/// One value of a validated scene. Defaults are filled in, quantities are in SI. Asking for a key that the schema does
/// not have is a programming error (std::logic_error); an optional key without a default is absent: test with `has`.
class Value {
 public:
  struct Data;
  explicit Value(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

  bool has(const std::string& key) const;
  /// Whether the scene itself states the key; false if a default stands in.
  bool given(const std::string& key) const;
  double real(const std::string& key) const;
  std::int64_t integer(const std::string& key) const;
  bool flag(const std::string& key) const;
  const std::string& text(const std::string& key) const;
  std::vector<double> reals(const std::string& key) const;
  Vec3 vector(const std::string& key) const;
  std::vector<std::string> texts(const std::string& key) const;
  TimeFunction function(const std::string& key) const;
  SpaceTimeFunction field_function(const std::string& key) const;
  /// Points (x, value), x ascending; empty if absent.
  std::vector<std::pair<double, double>> table(const std::string& key) const;
  /// A nested mapping. If the scene leaves it out (has() is false) and its keys all have defaults, those.
  Value child(const std::string& key) const;
  /// A list of mappings; empty if absent, as `reals` and `texts` are.
  std::vector<Value> items(const std::string& key) const;
  /// A mapping of named blocks, in the order of the file; empty if absent.
  std::vector<std::pair<std::string, Value>> entries(const std::string& key) const;

  /// Where the value of a key stands (of the mapping itself if the key is absent or empty).
  Where where(const std::string& key = "") const;
  /// Where a name in a mapping of named blocks stands.
  Where where_name(const std::string& key, const std::string& name) const;

 private:
  std::shared_ptr<const Data> data_;
};

/// The word of `valid` nearest to `word` by edit distance, or empty if none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& valid);
/// ", did you mean 'x'?" or "; valid: a, b, c" as fits.
std::string suggestion(const std::string& word, const std::vector<std::string>& valid);

}  // namespace tenon::scene
