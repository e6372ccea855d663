// SPDX-License-Identifier: BSD-3-Clause
// Frames for ParaView: .vtu pieces, .pvtu and .pvd, valid after every frame.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/fields/field.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// A field of one frame; values of all local nodes, or of all local elements (blocks one after the other).
struct OutputField {
  FieldDescription description;
  std::span<const double> values;
};

/// What one component shows in a frame. `coordinates` are the deformed ones, m.
struct OutputPart {
  std::string component;
  const Mesh* mesh = nullptr;
  std::span<const Vec3> coordinates;
  std::vector<OutputField> fields;
};

/// Writes `FOLDER/COMPONENT.pvd`, `FOLDER/all.pvd` (every component, as named parts) and the pieces in
/// `FOLDER/frames/`. Inline binary, LZ4 compressed: ParaView 5.11 of Debian shows nothing for appended data. Adds the
/// cell field `rank` and, where there are several blocks, `block`. Each file is written aside and renamed, .pvd last.
class VtkOutput {
 public:
  /// Collective. `resume_time`: on restart, frames of an earlier run up to and including this time are kept (NaN:
  /// none).
  VtkOutput(const Communicator& comm, std::string folder, double resume_time);
  ~VtkOutput();
  /// Collective. Throws Error(file) on all ranks if a file cannot be written.
  void write(double time, std::int64_t step, std::span<const OutputPart> parts);
  std::int64_t frames() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Collective. One state as `path` (.pvtu) and beside it a piece of each rank that owns elements. Throws Error(file) on
/// all ranks, and leaves nothing behind then.
void write_pvtu(const Communicator& comm, const std::string& path, const OutputPart& part);

}  // namespace tenon
