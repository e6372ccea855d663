// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "framework/io/checkpoint.hpp"
#include "framework/io/checkpoint_format.hpp"
#include "framework/io/hdf5_handle.hpp"

namespace tenon {

struct CheckpointReader::Impl {
  Communicator comm;
  std::string path;
  Hdf5Handle file;

  bool has_dataset(const std::string& name) const;
  bool has_attribute(const std::string& name) const { return H5Aexists(file, name.c_str()) > 0; }
  void read_attribute(const std::string& name, hid_t type, void* value) const;
  Hdf5Handle open_dataset(const std::string& name) const;
  /// Collective vote: throws "path: what" on all ranks unless all are ok.
  void expect(bool ok, const std::string& what) const;
};

void CheckpointReader::Impl::expect(bool ok, const std::string& what) const {
  std::optional<Error> mine;
  if (!ok) mine = Error(ExitCode::file, fmt::format("{}: {}", path, what));
  comm.throw_if_any(mine);
}

bool CheckpointReader::Impl::has_dataset(const std::string& name) const {
  // Each group on the way must be asked for in turn: H5Lexists fails if one is missing.
  for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
    if (slash > 0 && H5Lexists(file, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0;
}

void CheckpointReader::Impl::read_attribute(const std::string& name, hid_t type, void* value) const {
  expect(has_attribute(name), fmt::format("has no value '{}'; it was written for another scene or version", name));
  const Hdf5Handle attribute(H5Aopen(file, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Handle stored(attribute.valid() ? H5Aget_type(attribute) : -1, H5Tclose);
  const bool fits = stored.valid() && H5Tget_class(stored) == H5Tget_class(type) &&
                    H5Tget_size(stored) == H5Tget_size(type) && H5Aread(attribute, type, value) >= 0;
  expect(fits, fmt::format("value '{}' cannot be read: {}", name, fits ? "" : hdf5_reason()));
}

Hdf5Handle CheckpointReader::Impl::open_dataset(const std::string& name) const {
  expect(has_dataset(name), fmt::format("has no dataset '{}'; it was written for another scene or version", name));
  Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  expect(dataset.valid(), fmt::format("dataset '{}' cannot be opened", name));
  return dataset;
}

CheckpointReader::CheckpointReader(const Communicator& comm, std::string path) : impl_(new Impl{comm, path, {}}) {
  const Hdf5Quiet quiet;
  checkpoint_format::verify(comm, path);
  impl_->file = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, parallel_access(comm)), H5Fclose);
  impl_->expect(impl_->file.valid(), "cannot be opened as HDF5");
  const std::int64_t format = integer("format");
  impl_->expect(format == checkpoint_format::version && text("kind") == checkpoint_format::kind,
                "is not a Tenon checkpoint of this version");
}

CheckpointReader::~CheckpointReader() = default;

double CheckpointReader::scalar(const std::string& name) const {
  const Hdf5Quiet quiet;
  double value = 0;
  impl_->read_attribute(name, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::int64_t CheckpointReader::integer(const std::string& name) const {
  const Hdf5Quiet quiet;
  std::int64_t value = 0;
  impl_->read_attribute(name, H5T_NATIVE_INT64, &value);
  return value;
}

std::string CheckpointReader::text(const std::string& name) const {
  const Hdf5Quiet quiet;
  const Hdf5Handle dataset = impl_->open_dataset(name);
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  impl_->expect(
      H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Sget_simple_extent_npoints(space) == 1,
      fmt::format("dataset '{}' is not a text", name));
  std::string value(H5Tget_size(type), '\0');
  if (impl_->comm.rank() != 0) H5Sselect_none(space);
  const Hdf5Handle transfer = collective_transfer();
  const herr_t status = H5Dread(dataset, type, space, space, transfer, value.data());
  impl_->expect(status >= 0, fmt::format("text '{}' cannot be read", name));
  value.pop_back();  // the closing zero
  impl_->comm.broadcast(value);
  return value;
}

void CheckpointReader::array(const std::string& name, const GlobalOrder& order, std::span<double> values,
                             int components) const {
  const Hdf5Quiet quiet;
  const Impl& my = *impl_;
  if (order.global_count_ == 0) return;
  const Hdf5Handle dataset = my.open_dataset(name);
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  hsize_t shape[2] = {0, 0};
  const bool plane = H5Sget_simple_extent_ndims(space) == 2 && H5Sget_simple_extent_dims(space, shape, nullptr) == 2;
  my.expect(plane && H5Tequal(type, H5T_IEEE_F64LE) > 0, fmt::format("dataset '{}' is not a table of doubles", name));
  my.expect(shape[0] == static_cast<hsize_t>(order.global_count_) && shape[1] == static_cast<hsize_t>(components),
            fmt::format("dataset '{}' is {} x {}, expected {} x {}; it was written for another mesh or material", name,
                        shape[0], shape[1], order.global_count_, components));
  my.expect(values.size() == static_cast<std::size_t>(order.given_) * shape[1],
            fmt::format("dataset '{}': room for {} values instead of {} x {}", name, values.size(), order.given_,
                        components));

  std::vector<double> slab(static_cast<std::size_t>(order.slab_size_) * shape[1]);
  const auto first = static_cast<hsize_t>(order.slab_first_);
  const SlabSpaces spaces = slab_spaces(dataset, first, static_cast<hsize_t>(order.slab_size_), shape[1]);
  const Hdf5Handle transfer = collective_transfer();
  const herr_t status = H5Dread(dataset, H5T_NATIVE_DOUBLE, spaces.memory, spaces.file, transfer, slab.data());
  my.expect(status >= 0, fmt::format("dataset '{}' cannot be read", name));

  const std::int64_t sum = my.comm.sum(static_cast<std::int64_t>(checkpoint_format::checksum(first * shape[1], slab)));
  std::int64_t said = 0;
  const Hdf5Handle attribute(H5Aopen(dataset, "checksum", H5P_DEFAULT), H5Aclose);
  my.expect(attribute.valid() && H5Aread(attribute, H5T_NATIVE_INT64, &said) >= 0 && said == sum,
            fmt::format("dataset '{}' is damaged (its checksum differs); use an older checkpoint", name));
  order.from_slab(slab, values, components);
}

bool CheckpointReader::has(const std::string& name) const {
  const Hdf5Quiet quiet;
  return impl_->has_attribute(name) || impl_->has_dataset(name);
}

}  // namespace tenon
