// SPDX-License-Identifier: BSD-3-Clause
// Validates the header of a netCDF classic file before the library sees it.
#include "framework/mesh_files/netcdf_classic.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <set>
#include <vector>

#include "framework/mesh_files/read_support.hpp"

namespace tenon::mesh_file {
namespace {

constexpr std::uint64_t longest_name = 256;
constexpr std::uint64_t most_dimensions = 1024;
constexpr std::uint64_t beyond = std::uint64_t{1} << 62;  ///< more bytes than any file has
enum Tag : std::uint32_t { absent = 0, dimension_list = 10, variable_list = 11, attribute_list = 12 };

struct Dimension {
  std::string name;
  std::uint64_t size;  ///< 0 for the record dimension
};

struct Variable {
  std::string name;
  std::uint64_t bytes;  ///< of all values, or of one record
  std::uint64_t begin;  ///< place in the file
  bool record;
};

class Header {
 public:
  explicit Header(const std::string& path) : path_(path), size_(size_of(path)), in_(path, std::ios::binary) {}

  void validate() {
    const std::string magic = bytes(4);
    version_ = static_cast<unsigned char>(magic[3]);
    if (magic.compare(0, 3, "CDF") != 0 || (version_ != 1 && version_ != 2 && version_ != 5))
      refuse(path_, "is not a netCDF classic file of version 1, 2 or 5");
    records_ = count();
    read_dimensions();
    skip_attributes();
    read_variables();
    check_extents();
  }

 private:
  [[noreturn]] void corrupt(const std::string& what) const {
    refuse(path_, "the netCDF header is corrupt at byte " + std::to_string(at_) + ": " + what);
  }

  std::string bytes(std::uint64_t n) {
    if (n > size_ - at_) corrupt("the file ends within the header (truncated?)");
    std::string out(static_cast<std::size_t>(n), '\0');
    in_.read(out.data(), static_cast<std::streamsize>(n));
    if (!in_) corrupt("cannot be read");
    at_ += n;
    return out;
  }
  void skip(std::uint64_t n) {
    if (n > size_ - at_) corrupt("the file ends within the header (truncated?)");
    in_.seekg(static_cast<std::streamoff>(n), std::ios::cur);
    at_ += n;
  }

  std::uint64_t big_endian(int width) {
    std::uint64_t value = 0;
    for (const char c : bytes(static_cast<std::uint64_t>(width))) value = value << 8 | static_cast<unsigned char>(c);
    return value;
  }
  std::uint32_t word() { return static_cast<std::uint32_t>(big_endian(4)); }
  /// NON_NEG of the specification: 32 bits, in CDF-5 64.
  std::uint64_t count() { return big_endian(version_ == 5 ? 8 : 4); }

  std::uint64_t list(Tag tag, const char* what) {
    const std::uint32_t found = word();
    const std::uint64_t entries = count();
    if (found == absent && entries == 0) return 0;
    if (found != tag) corrupt(std::string("expected the list of ") + what);
    if (entries > (size_ - at_) / 8) corrupt(std::string("impossible number of ") + what);
    return entries;
  }

  std::string name() {
    const std::uint64_t length = count();
    if (length == 0 || length > longest_name) corrupt("impossible length of a name");
    const std::string text = bytes(length);
    for (const char c : text)
      if (static_cast<unsigned char>(c) < 0x20 || c == '/' || c == 0x7f) corrupt("a name has an impossible character");
    skip((4 - length % 4) % 4);
    return text;
  }

  std::uint64_t type_width() {
    constexpr std::array<std::uint8_t, 12> width{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const std::uint32_t type = word();
    if (type == 0 || type >= (version_ == 5 ? 12u : 7u)) corrupt("unknown type of values");
    return width[type];
  }

  void read_dimensions() {
    std::set<std::string> names;
    bool record = false;
    for (std::uint64_t left = list(dimension_list, "dimensions"); left > 0; --left) {
      Dimension d{name(), 0};
      d.size = count();
      if (!names.insert(d.name).second) corrupt("two dimensions named '" + d.name + "'");
      if (d.size > beyond) corrupt("impossible size of '" + d.name + "'");
      if (d.size == 0 && record) corrupt("two record dimensions");
      record = record || d.size == 0;
      dimensions_.push_back(std::move(d));
    }
  }

  void skip_attributes() {
    for (std::uint64_t left = list(attribute_list, "attributes"); left > 0; --left) {
      name();
      const std::uint64_t width = type_width();
      const std::uint64_t values = count();
      if (values > (size_ - at_) / width) corrupt("impossible length of an attribute");
      skip((values * width + 3) / 4 * 4);
    }
  }

  void read_variables() {
    std::set<std::string> names;
    for (std::uint64_t left = list(variable_list, "variables"); left > 0; --left) {
      Variable variable{name(), 0, 0, false};
      if (!names.insert(variable.name).second) corrupt("two variables named '" + variable.name + "'");
      read_variable(variable);
      variables_.push_back(std::move(variable));
    }
  }

  void read_variable(Variable& variable) {
    const std::uint64_t rank = count();
    if (rank > most_dimensions) corrupt("impossible rank of '" + variable.name + "'");
    variable.bytes = 1;
    for (std::uint64_t d = 0; d < rank; ++d) {
      const std::uint64_t index = count();
      if (index >= dimensions_.size()) corrupt("'" + variable.name + "' has a dimension that does not exist");
      const std::uint64_t extent = dimensions_[static_cast<std::size_t>(index)].size;
      if (extent == 0 && d != 0) corrupt("the record dimension of '" + variable.name + "' is not the first");
      if (extent == 0)
        variable.record = true;
      else
        variable.bytes = times(variable.bytes, extent);
    }
    skip_attributes();
    variable.bytes = times(variable.bytes, type_width());
    count();  // the size, which the specification calls redundant
    variable.begin = big_endian(version_ == 1 ? 4 : 8);
  }

  /// Product, or a number greater than any file.
  static std::uint64_t times(std::uint64_t a, std::uint64_t b) { return a > beyond / b ? beyond : a * b; }

  /// Values of record variables come record by record, those of one record each padded to four bytes unless they are
  /// alone.
  void check_extents() const {
    const auto records =
        std::count_if(variables_.begin(), variables_.end(), [](const Variable& v) { return v.record; });
    std::uint64_t record_size = 0;
    for (const Variable& v : variables_)
      if (v.record) record_size = std::min(beyond, record_size + (records > 1 ? (v.bytes + 3) / 4 * 4 : v.bytes));
    // A writer that streams does not know the number of records.
    const std::uint64_t streaming = version_ == 5 ? ~std::uint64_t{0} : std::uint64_t{0xffffffff};
    for (const Variable& v : variables_) {
      std::uint64_t before_last = 0;
      if (v.record) {
        if (records_ == 0 || records_ == streaming) continue;
        before_last = times(records_ - 1, std::max<std::uint64_t>(record_size, 1));
      }
      const bool fits = v.begin <= size_ && before_last <= size_ - v.begin && v.bytes <= size_ - v.begin - before_last;
      if (!fits)
        refuse(path_, "is truncated: it has " + std::to_string(size_) + " bytes, and the values of '" + v.name +
                          "' do not all fit");
    }
  }

  std::string path_;
  std::uint64_t size_, at_ = 0;
  std::ifstream in_;
  int version_ = 1;
  std::uint64_t records_ = 0;
  std::vector<Dimension> dimensions_;
  std::vector<Variable> variables_;
};

}  // namespace

void validate_classic(const std::string& path) {
  Header(path).validate();
}

}  // namespace tenon::mesh_file
