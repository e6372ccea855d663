// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <filesystem>

#include "framework/io/checkpoint.hpp"
#include "framework/io/checkpoint_format.hpp"
#include "framework/io/hdf5_handle.hpp"
#include "framework/io/posix_file.hpp"

namespace tenon {

using checkpoint_format::Preamble;

struct CheckpointWriter::Impl {
  Communicator comm;
  std::string path, part;
  Hdf5Handle file;
  std::vector<double> slab;
  std::vector<std::string> datasets;
  bool finished = false;

  void create();
  void attribute(const std::string& name, hid_t type, const void* value);
  Hdf5Handle create_dataset(const std::string& name, hid_t type, hid_t space);
  void reserve(haddr_t first, std::uint64_t bytes) const;
  void abandon();
  /// Collective vote on one HDF5 call that every rank has made.
  void vote(bool ok, const std::string& what) const;
};

void CheckpointWriter::Impl::vote(bool ok, const std::string& what) const {
  std::optional<Error> mine;
  if (!ok) {
    std::string hint;
    struct statvfs disk {};
    const std::string folder = std::filesystem::path(path).parent_path().string();
    if (::statvfs(folder.empty() ? "." : folder.c_str(), &disk) == 0 && disk.f_bavail * disk.f_frsize < (1u << 20))
      hint = "; the disk is full";
    mine = Error(ExitCode::file,
                 fmt::format("{}: checkpoint cannot be written: {}: {}{}", path, what, hdf5_reason(), hint));
  }
  comm.throw_if_any(mine);
}

void CheckpointWriter::Impl::create() {
  const Hdf5Quiet quiet;
  // Opened once by the system's own call, because its reason for a failure is clearer than that of MPI-IO.
  comm.vote_on_root([&] { PosixFile(part, O_WRONLY | O_CREAT | O_TRUNC); });
  const Hdf5Handle access = parallel_access(comm);
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_userblock(creation, checkpoint_format::user_block);
  H5Pset_obj_track_times(creation, false);
  file = Hdf5Handle(H5Fcreate(part.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose);
  vote(file.valid(), "file cannot be made");
}

void CheckpointWriter::Impl::attribute(const std::string& name, hid_t type, const void* value) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  vote(attribute.valid() && H5Awrite(attribute, type, value) >= 0, name);
}

Hdf5Handle CheckpointWriter::Impl::create_dataset(const std::string& name, hid_t type, hid_t space) {
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  Hdf5Handle dataset(H5Dcreate2(file, name.c_str(), type, space, links, creation, H5P_DEFAULT), H5Dclose);
  vote(dataset.valid(), name);
  datasets.push_back(name);
  return dataset;
}

// Takes the room on the disk before HDF5 writes: a full disk is then found here, with the system's reason and on one
// rank, and not in the middle of a collective write, after which HDF5 can hardly be closed.
void CheckpointWriter::Impl::reserve(haddr_t first, std::uint64_t bytes) const {
  comm.vote_on_root([&] {
    if (first != HADDR_UNDEF && bytes > 0) PosixFile(part, O_WRONLY).reserve(first, bytes);
  });
}

// HDF5 that cannot close a file crashes when the program ends. So the datasets are deleted first, which leaves next to
// nothing to write, and the room of the file is given back to a full disk.
void CheckpointWriter::Impl::abandon() {
  if (!file.valid()) return;
  for (const std::string& name : datasets) H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  if (comm.rank() == 0 && ::truncate(part.c_str(), 0) != 0) ::unlink(part.c_str());
  comm.barrier();
  file.close();
}

CheckpointWriter::CheckpointWriter(const Communicator& comm, std::string path)
    : impl_(new Impl{comm, path, path + ".part", {}, {}, {}}) {
  impl_->create();
  integer("format", checkpoint_format::version);
  text("kind", checkpoint_format::kind);
}

CheckpointWriter::~CheckpointWriter() {
  if (impl_->finished) return;
  const Hdf5Quiet quiet;
  impl_->abandon();
  if (impl_->comm.rank() == 0) ::unlink(impl_->part.c_str());
}

void CheckpointWriter::scalar(const std::string& name, double value) {
  const Hdf5Quiet quiet;
  std::vector<double> of_root{value};
  impl_->comm.broadcast(of_root);
  impl_->attribute(name, H5T_NATIVE_DOUBLE, of_root.data());
}

void CheckpointWriter::integer(const std::string& name, std::int64_t value) {
  const Hdf5Quiet quiet;
  std::vector<std::int64_t> of_root{value};
  impl_->comm.broadcast(of_root);
  impl_->attribute(name, H5T_NATIVE_INT64, of_root.data());
}

void CheckpointWriter::text(const std::string& name, const std::string& value) {
  const Hdf5Quiet quiet;
  // A dataset, because an attribute cannot hold more than 64 KiB. The closing zero also makes "" writable.
  std::string of_root = value;
  impl_->comm.broadcast(of_root);
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, of_root.size() + 1);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle dataset = impl_->create_dataset(name, type, space);
  impl_->reserve(H5Dget_offset(dataset), of_root.size() + 1);
  if (impl_->comm.rank() != 0) H5Sselect_none(space);
  const Hdf5Handle transfer = collective_transfer();
  const herr_t status = H5Dwrite(dataset, type, space, space, transfer, of_root.c_str());
  impl_->vote(status >= 0, name);
}

void CheckpointWriter::array(const std::string& name, const GlobalOrder& order, std::span<const double> values,
                             int components) {
  const Hdf5Quiet quiet;
  impl_->comm.vote([&] {
    if (!order.each_once_)
      throw Error(ExitCode::file,
                  fmt::format("{}: dataset {}: not every id is given by exactly one rank", impl_->path, name));
    if (values.size() != static_cast<std::size_t>(order.given_) * static_cast<std::size_t>(components))
      throw Error(ExitCode::file, fmt::format("{}: dataset {}: {} values for {} ids of {} components", impl_->path,
                                              name, values.size(), order.given_, components));
  });
  if (order.global_count_ == 0) return;  // h5diff calls an empty dataset "not comparable"
  impl_->slab.resize(static_cast<std::size_t>(order.slab_size_) * static_cast<std::size_t>(components));
  order.to_slab(values, impl_->slab, components);

  const hsize_t shape[2] = {static_cast<hsize_t>(order.global_count_), static_cast<hsize_t>(components)};
  const Hdf5Handle space(H5Screate_simple(2, shape, nullptr), H5Sclose);
  const Hdf5Handle dataset = impl_->create_dataset(name, H5T_IEEE_F64LE, space);
  impl_->reserve(H5Dget_offset(dataset), shape[0] * shape[1] * sizeof(double));
  const auto first = static_cast<hsize_t>(order.slab_first_);
  const SlabSpaces slab = slab_spaces(dataset, first, static_cast<hsize_t>(order.slab_size_), shape[1]);
  const Hdf5Handle transfer = collective_transfer();
  const herr_t status = H5Dwrite(dataset, H5T_NATIVE_DOUBLE, slab.memory, slab.file, transfer, impl_->slab.data());
  impl_->vote(status >= 0, "dataset " + name);

  const std::int64_t sum =
      impl_->comm.sum(static_cast<std::int64_t>(checkpoint_format::checksum(first * shape[1], impl_->slab)));
  const Hdf5Handle one(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(dataset, "checksum", H5T_STD_I64LE, one, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  impl_->vote(attribute.valid() && H5Awrite(attribute, H5T_NATIVE_INT64, &sum) >= 0, "checksum of " + name);
}

void CheckpointWriter::finish() {
  Impl& my = *impl_;
  const Hdf5Quiet quiet;
  my.vote(H5Fflush(my.file, H5F_SCOPE_GLOBAL) >= 0, "the last bytes");
  my.vote(my.file.close(), "closing");

  std::vector<std::uint64_t> bytes(1);
  my.comm.vote_on_root([&] { bytes[0] = PosixFile(my.part, O_RDONLY).size(); });
  my.comm.broadcast(bytes);
  Preamble preamble;
  preamble.file_bytes = bytes[0];
  preamble.file_checksum = checkpoint_format::file_checksum(my.comm, my.part, bytes[0]);
  preamble.own_checksum = checkpoint_format::own_checksum(preamble);
  my.comm.vote_on_root([&] {
    {
      const PosixFile file(my.part, O_WRONLY);
      file.write_at(&preamble, sizeof preamble, 0);
      file.sync();
    }
    rename_file(my.part, my.path);
    checkpoint_format::sync_folder(my.path);
  });
  my.finished = true;
}

}  // namespace tenon
