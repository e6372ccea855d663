// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/vtk_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

#include "framework/io/posix_file.hpp"
#include "framework/io/pvd_file.hpp"
#include "framework/io/vtk_piece.hpp"

namespace tenon {

namespace fs = std::filesystem;

namespace {

constexpr const char* all_name = "all";

/// Number of the frame that a file of `component` in frames/ belongs to: COMPONENT-000012.pvtu,
/// COMPONENT-000012-r3.vtu.
std::optional<std::int64_t> frame_of(std::string_view file, std::string_view component) {
  if (!file.starts_with(component)) return {};
  file.remove_prefix(component.size());
  if (!file.starts_with('-')) return {};
  file.remove_prefix(1);
  std::int64_t number = -1;
  const auto [end, error] = std::from_chars(file.data(), file.data() + file.size(), number);
  const std::string_view rest(end, static_cast<std::size_t>(file.data() + file.size() - end));
  const bool ours = rest == ".vtu" || rest == ".pvtu" || (rest.starts_with("-r") && rest.ends_with(".vtu"));
  if (error != std::errc{} || number < 0 || end - file.data() < 6 || !ours) return {};
  return number;
}

}  // namespace

struct VtkOutput::Impl {
  Communicator comm;
  std::string folder;
  std::vector<double> times;      // of the frames, ascending; the same on all ranks
  std::vector<PvdEntry> entries;  // rank 0: what all.pvd says

  std::string list(const std::string& name) const { return folder + "/" + name + ".pvd"; }
  void resume(double resume_time);
  void drop_files(const std::vector<std::string>& components, std::int64_t first_dropped) const;
  void write_lists(const std::vector<std::string>& components) const;
  std::string write_frame(const OutputPart& part, std::int64_t number) const;
  std::vector<std::string> component_names() const;
};

std::vector<std::string> VtkOutput::Impl::component_names() const {
  std::vector<std::string> names;
  for (const PvdEntry& e : entries)
    if (std::ranges::find(names, e.name) == names.end()) names.push_back(e.name);
  return names;
}

// The lists change before the files do, so that they never name a file that is not there.
void VtkOutput::Impl::resume(double resume_time) {
  make_folder(folder + "/frames");
  if (!fs::exists(list(all_name))) return;
  const bool fresh = std::isnan(resume_time);
  try {
    entries = read_pvd(list(all_name));
  } catch (const Error&) {
    if (!fresh) throw;
  }
  const std::vector<std::string> components = component_names();
  std::erase_if(entries, [&](const PvdEntry& e) { return fresh || e.time > resume_time; });
  for (const PvdEntry& e : entries)
    if (times.empty() || e.time > times.back()) times.push_back(e.time);
  write_lists(components);
  drop_files(components, static_cast<std::int64_t>(times.size()));
}

void VtkOutput::Impl::drop_files(const std::vector<std::string>& components, std::int64_t first_dropped) const {
  std::vector<fs::path> dropped;
  std::error_code error;
  for (fs::directory_iterator it(folder + "/frames", error), end; !error && it != end; it.increment(error))
    for (const std::string& component : components)
      if (const auto number = frame_of(it->path().filename().string(), component); number && *number >= first_dropped)
        dropped.push_back(it->path());
  for (const fs::path& path : dropped) fs::remove(path, error);
}

void VtkOutput::Impl::write_lists(const std::vector<std::string>& components) const {
  for (const std::string& component : components) {
    std::vector<PvdEntry> own;
    std::ranges::copy_if(entries, std::back_inserter(own), [&](const PvdEntry& e) { return e.name == component; });
    for (PvdEntry& e : own) e.part = 0;
    write_and_rename(list(component), format_pvd(own));
  }
  write_and_rename(list(all_name), format_pvd(entries));
}

/// Collective. Returns the file that shows the part, relative to the folder.
std::string VtkOutput::Impl::write_frame(const OutputPart& part, std::int64_t number) const {
  const std::string stem = fmt::format("{}-{:06}", part.component, number), frames = folder + "/frames/";
  if (comm.size() == 1) {
    comm.vote([&] { write_piece(frames + stem + ".vtu", part); });
    return "frames/" + stem + ".vtu";
  }
  const std::int64_t mine = owned_elements(part);
  const bool nobody = comm.sum(mine) == 0;
  const auto piece = [&](std::size_t rank) { return fmt::format("{}-r{}.vtu", stem, rank); };
  comm.vote([&] {
    if (mine > 0 || (nobody && comm.rank() == 0))
      write_piece(frames + piece(static_cast<std::size_t>(comm.rank())), part);
  });
  const std::vector<std::int64_t> counts = comm.gather(std::span(&mine, 1));
  comm.vote_on_root([&] {
    std::vector<std::string> pieces;
    for (std::size_t rank = 0; rank < counts.size(); ++rank)
      if (counts[rank] > 0 || (nobody && rank == 0)) pieces.push_back(piece(rank));
    write_and_rename(frames + stem + ".pvtu", format_pvtu(part, pieces));
  });
  return "frames/" + stem + ".pvtu";
}

VtkOutput::VtkOutput(const Communicator& comm, std::string folder, double resume_time)
    : impl_(new Impl{comm, std::move(folder), {}, {}}) {
  comm.vote_on_root([&] { impl_->resume(resume_time); });
  comm.broadcast(impl_->times);
}

VtkOutput::~VtkOutput() = default;

void VtkOutput::write(double time, std::int64_t step, std::span<const OutputPart> parts) {
  Impl& my = *impl_;
  my.comm.vote([&] {
    if (!std::isfinite(time)) throw Error(ExitCode::unstable, fmt::format("step {}: the time is {}", step, time));
    for (const OutputPart& part : parts) {
      if (part.component == all_name)
        throw Error(ExitCode::usage, "a component cannot be named 'all': all.pvd shows every component");
      check_fields(part);
    }
  });
  // A frame that is written again (of a state that was restored) takes the place of the old one.
  while (!my.times.empty() && my.times.back() >= time) my.times.pop_back();
  std::erase_if(my.entries, [&](const PvdEntry& e) { return e.time >= time; });

  const auto number = static_cast<std::int64_t>(my.times.size());
  std::vector<PvdEntry> added;
  for (const OutputPart& part : parts)
    added.push_back({time, static_cast<int>(added.size()), part.component, my.write_frame(part, number)});
  my.times.push_back(time);
  my.comm.vote_on_root([&] {
    my.entries.insert(my.entries.end(), added.begin(), added.end());
    my.write_lists(my.component_names());
  });
}

void write_pvtu(const Communicator& comm, const std::string& path, const OutputPart& part) {
  const fs::path file(path);
  const auto piece = [&](std::size_t rank) { return fmt::format("{}-r{}.vtu", file.stem().string(), rank); };
  const std::string mine = (file.parent_path() / piece(static_cast<std::size_t>(comm.rank()))).string();
  const std::int64_t owned = owned_elements(part);
  const bool nobody = comm.sum(owned) == 0, writes = owned > 0 || (nobody && comm.rank() == 0);
  try {
    comm.vote([&] {
      check_fields(part);
      if (writes) write_piece(mine, part);
    });
    const std::int64_t one = writes ? 1 : 0;
    const std::vector<std::int64_t> writers = comm.gather(std::span(&one, 1));
    comm.vote_on_root([&] {
      std::vector<std::string> pieces;
      for (std::size_t rank = 0; rank < writers.size(); ++rank)
        if (writers[rank] > 0) pieces.push_back(piece(rank));
      write_and_rename(path, format_pvtu(part, pieces));
    });
  } catch (const Error&) {
    std::error_code none;
    fs::remove(mine, none);
    fs::remove(mine + ".part", none);
    throw;
  }
}

std::int64_t VtkOutput::frames() const {
  return static_cast<std::int64_t>(impl_->times.size());
}

}  // namespace tenon
