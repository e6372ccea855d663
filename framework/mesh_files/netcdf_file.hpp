// SPDX-License-Identifier: BSD-3-Clause
// A netCDF file (classic or HDF5) open for reading, with every access checked. Private to the room.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tenon::mesh_file {

class NetcdfFile {
 public:
  /// Refuses what is not netCDF, a corrupt header and a truncated file.
  explicit NetcdfFile(const std::string& path);
  ~NetcdfFile();
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  const std::string& path() const { return path_; }
  /// Length of a dimension; empty if there is none of that name.
  std::optional<std::int64_t> dimension(const std::string& name) const;
  bool has(const std::string& variable) const;

  /// All values of a variable. Refuses a missing variable, one of another type and one of another length.
  std::vector<std::int64_t> integers(const std::string& variable, std::int64_t length) const;
  std::vector<double> reals(const std::string& variable, std::int64_t length) const;
  /// Row `row` of a variable of two dimensions, of `length` values.
  std::vector<double> reals_of_row(const std::string& variable, std::int64_t row, std::int64_t length) const;
  /// The rows of a two-dimensional text variable, without trailing blanks and NULs; `rows` of them.
  std::vector<std::string> texts(const std::string& variable, std::int64_t rows) const;
  /// Text attribute of a variable; empty if there is none.
  std::string attribute(const std::string& variable, const std::string& name) const;

 private:
  struct Variable {
    int id = 0, type = 0;
    std::vector<std::size_t> shape;
    std::uint64_t values = 1;
  };
  Variable inquire(const std::string& variable) const;
  Variable inquire_numbers(const std::string& variable, std::int64_t length) const;
  void require(int status, const std::string& action) const;

  std::string path_;
  std::uint64_t bytes_ = 0;
  bool classic_ = false;
  int id_ = -1;
};

/// Whether the file begins with the signature of HDF5.
bool is_hdf5(const std::string& start);

}  // namespace tenon::mesh_file
