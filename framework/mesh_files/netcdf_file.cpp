// SPDX-License-Identifier: BSD-3-Clause
// A netCDF file (classic or HDF5) open for reading, with every access checked.
#include "framework/mesh_files/netcdf_file.hpp"

#include <vtk_netcdf.h>

#include <array>
#include <filesystem>

#include "framework/mesh_files/netcdf_classic.hpp"
#include "framework/mesh_files/read_support.hpp"

namespace tenon::mesh_file {
namespace {

// An HDF5 file may be compressed. Real meshes shrink by 2 to 50; more values per byte than this are a corrupt size.
constexpr std::uint64_t most_values_per_byte = 256;
constexpr std::size_t longest_attribute = 4096;
constexpr std::size_t longest_text = 4096;

std::string trimmed(const char* text, std::size_t length) {
  std::string out(text, length);
  out.resize(std::min(out.find('\0'), out.size()));
  while (!out.empty() && (out.back() == ' ' || out.back() == '\t')) out.pop_back();
  return printable(out);
}

}  // namespace

bool is_hdf5(const std::string& start) {
  return start.compare(0, 8, "\x89HDF\r\n\x1a\n") == 0;
}

NetcdfFile::NetcdfFile(const std::string& path) : path_(path), bytes_(size_of(path)) {
  const std::string start = start_of(path, 8);
  classic_ = !is_hdf5(start);
  if (classic_) validate_classic(path);
  // An absolute path, because the library would take one that looks like an URL for a server.
  const std::string absolute = std::filesystem::absolute(path).string();
  require(nc_open(absolute.c_str(), NC_NOWRITE, &id_), "cannot be opened");
}

NetcdfFile::~NetcdfFile() {
  nc_close(id_);
}

void NetcdfFile::require(int status, const std::string& action) const {
  if (status != NC_NOERR) refuse(path_, action + " (netCDF: " + nc_strerror(status) + "); truncated or corrupt?");
}

std::optional<std::int64_t> NetcdfFile::dimension(const std::string& name) const {
  int id = 0;
  std::size_t length = 0;
  if (nc_inq_dimid(id_, name.c_str(), &id) != NC_NOERR) return std::nullopt;
  require(nc_inq_dimlen(id_, id, &length), "dimension '" + name + "' cannot be read");
  if (length > static_cast<std::size_t>(INT64_MAX)) refuse(path_, "dimension '" + name + "' is impossibly large");
  return static_cast<std::int64_t>(length);
}

bool NetcdfFile::has(const std::string& variable) const {
  int id = 0;
  return nc_inq_varid(id_, variable.c_str(), &id) == NC_NOERR;
}

NetcdfFile::Variable NetcdfFile::inquire(const std::string& variable) const {
  Variable v;
  int rank = 0;
  if (nc_inq_varid(id_, variable.c_str(), &v.id) != NC_NOERR)
    refuse(path_, "has no variable '" + variable + "'; expected an Exodus II mesh");
  require(nc_inq_vartype(id_, v.id, &v.type), "variable '" + variable + "' cannot be examined");
  require(nc_inq_varndims(id_, v.id, &rank), "variable '" + variable + "' cannot be examined");
  if (rank < 0 || rank > 2) refuse(path_, "variable '" + variable + "' has an impossible rank");
  std::array<int, 2> dimensions{};
  require(nc_inq_vardimid(id_, v.id, dimensions.data()), "variable '" + variable + "' cannot be examined");
  const std::uint64_t most = classic_ ? bytes_ : bytes_ * most_values_per_byte;
  for (int d = 0; d < rank; ++d) {
    std::size_t length = 0;
    require(nc_inq_dimlen(id_, dimensions[static_cast<std::size_t>(d)], &length),
            "a dimension of '" + variable + "' cannot be read");
    if (length != 0 && v.values > most / length)
      refuse(path_, "variable '" + variable + "' is larger than the file can hold; corrupt?");
    v.values *= length;
    v.shape.push_back(length);
  }
  return v;
}

NetcdfFile::Variable NetcdfFile::inquire_numbers(const std::string& variable, std::int64_t length) const {
  Variable v = inquire(variable);
  if (v.values != static_cast<std::uint64_t>(length))
    refuse(path_, "variable '" + variable + "' has " + std::to_string(v.values) + " values, expected " +
                      std::to_string(length));
  return v;
}

std::vector<std::int64_t> NetcdfFile::integers(const std::string& variable, std::int64_t length) const {
  static_assert(sizeof(long long) == sizeof(std::int64_t));
  const Variable v = inquire_numbers(variable, length);
  const bool integral =
      v.type == NC_BYTE || (v.type >= NC_SHORT && v.type <= NC_INT) || (v.type >= NC_UBYTE && v.type <= NC_UINT64);
  if (!integral) refuse(path_, "variable '" + variable + "' is not of integers");
  std::vector<long long> values(static_cast<std::size_t>(v.values));
  if (!values.empty()) require(nc_get_var_longlong(id_, v.id, values.data()), "'" + variable + "' cannot be read");
  return {values.begin(), values.end()};
}

std::vector<double> NetcdfFile::reals(const std::string& variable, std::int64_t length) const {
  const Variable v = inquire_numbers(variable, length);
  if (v.type != NC_FLOAT && v.type != NC_DOUBLE) refuse(path_, "variable '" + variable + "' is not of real numbers");
  std::vector<double> values(static_cast<std::size_t>(v.values));
  if (!values.empty()) require(nc_get_var_double(id_, v.id, values.data()), "'" + variable + "' cannot be read");
  return values;
}

std::vector<double> NetcdfFile::reals_of_row(const std::string& variable, std::int64_t row, std::int64_t length) const {
  const Variable v = inquire(variable);
  if (v.shape.size() != 2 || static_cast<std::size_t>(row) >= v.shape[0] ||
      v.shape[1] != static_cast<std::size_t>(length))
    refuse(path_, "variable '" + variable + "' has no row " + std::to_string(row + 1) + " of " +
                      std::to_string(length) + " values");
  if (v.type != NC_FLOAT && v.type != NC_DOUBLE) refuse(path_, "variable '" + variable + "' is not of real numbers");
  std::vector<double> values(static_cast<std::size_t>(length));
  const std::array<std::size_t, 2> start{static_cast<std::size_t>(row), 0}, count{1, values.size()};
  if (!values.empty())
    require(nc_get_vara_double(id_, v.id, start.data(), count.data(), values.data()),
            "'" + variable + "' cannot be read");
  return values;
}

std::vector<std::string> NetcdfFile::texts(const std::string& variable, std::int64_t rows) const {
  const Variable v = inquire(variable);
  if (v.type != NC_CHAR || v.shape.size() != 2 || v.shape[0] != static_cast<std::size_t>(rows) ||
      v.shape[1] > longest_text)
    refuse(path_, "variable '" + variable + "' is not a list of " + std::to_string(rows) + " names");
  std::string all(static_cast<std::size_t>(v.values), '\0');
  if (!all.empty()) require(nc_get_var_text(id_, v.id, all.data()), "'" + variable + "' cannot be read");
  std::vector<std::string> out;
  for (std::size_t r = 0; r < v.shape[0]; ++r) out.push_back(trimmed(all.data() + r * v.shape[1], v.shape[1]));
  return out;
}

std::string NetcdfFile::attribute(const std::string& variable, const std::string& name) const {
  const Variable v = inquire(variable);
  nc_type type = 0;
  std::size_t length = 0;
  if (nc_inq_att(id_, v.id, name.c_str(), &type, &length) != NC_NOERR) return "";
  if (type != NC_CHAR || length > longest_attribute)
    refuse(path_, "attribute '" + name + "' of '" + variable + "' is not a short text");
  std::string text(length, '\0');
  if (length > 0) require(nc_get_att_text(id_, v.id, name.c_str(), text.data()), "'" + name + "' cannot be read");
  return trimmed(text.data(), text.size());
}

}  // namespace tenon::mesh_file
