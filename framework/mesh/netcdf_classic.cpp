// SPDX-License-Identifier: BSD-3-Clause
// Validates the header of a netCDF classic file before the library sees it.
#include "framework/mesh/netcdf_classic.hpp"

#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>
#include <vector>

#include "framework/mesh/read_support.hpp"

namespace tenon::mesh_file {
namespace {

constexpr std::uint64_t longest_name = 256;
constexpr std::uint64_t most_dimensions = 1024;
enum Tag : std::uint32_t { absent = 0, dimension_list = 10, variable_list = 11, attribute_list = 12 };

struct Dimension {
  std::string name;
  std::uint64_t size;  ///< 0 for the record dimension
};

class Header {
 public:
  explicit Header(const std::string& path) : path_(path), size_(size_of(path)), in_(path, std::ios::binary) {}

  std::set<std::string> validate() {
    const std::string magic = bytes(4);
    version_ = static_cast<unsigned char>(magic[3]);
    if (magic.compare(0, 3, "CDF") != 0 || (version_ != 1 && version_ != 2 && version_ != 5))
      refuse(path_, "is not a netCDF classic file of version 1, 2 or 5");
    records_ = count();
    read_dimensions();
    skip_attributes();
    return read_variables();
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
      if (d.size > std::numeric_limits<std::uint64_t>::max() / 2) corrupt("impossible size of '" + d.name + "'");
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

  std::set<std::string> read_variables() {
    std::set<std::string> names, truncated;
    for (std::uint64_t left = list(variable_list, "variables"); left > 0; --left) {
      const std::string variable = name();
      if (!names.insert(variable).second) corrupt("two variables named '" + variable + "'");
      if (!variable_within_file(variable)) truncated.insert(variable);
    }
    return truncated;
  }

  /// Reads the rest of one variable's entry. A record variable counts as outside when it has a record.
  bool variable_within_file(const std::string& variable) {
    const std::uint64_t rank = count();
    if (rank > most_dimensions) corrupt("impossible rank of '" + variable + "'");
    std::optional<std::uint64_t> values = 1;
    bool record = false;
    for (std::uint64_t d = 0; d < rank; ++d) {
      const std::uint64_t index = count();
      if (index >= dimensions_.size()) corrupt("'" + variable + "' has a dimension that does not exist");
      const std::uint64_t extent = dimensions_[static_cast<std::size_t>(index)].size;
      if (extent == 0 && d != 0) corrupt("the record dimension of '" + variable + "' is not the first");
      record = record || extent == 0;
      if (!values || (extent != 0 && *values > size_ / extent))
        values.reset();
      else if (extent != 0)
        *values *= extent;
    }
    skip_attributes();
    const std::uint64_t width = type_width();
    count();  // the size, which the specification calls redundant
    const std::uint64_t begin = big_endian(version_ == 1 ? 4 : 8);
    if (record) return records_ == 0;
    return values && begin <= size_ && *values <= (size_ - begin) / width;
  }

  std::string path_;
  std::uint64_t size_, at_ = 0;
  std::ifstream in_;
  int version_ = 1;
  std::uint64_t records_ = 0;
  std::vector<Dimension> dimensions_;
};

}  // namespace

std::set<std::string> truncated_variables(const std::string& path) {
  return Header(path).validate();
}

}  // namespace tenon::mesh_file
