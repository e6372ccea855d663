// SPDX-License-Identifier: BSD-3-Clause
// The particles that a rank works on: columns of numbers, all in one order.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "framework/base/types.hpp"

namespace tenon {

/// What a shift or a mirror makes of a value.
enum class ColumnKind : std::uint8_t {
  scalar,    ///< nothing, of any number of components
  position,  ///< shifted and mirrored
  vector,    ///< mirrored
  tensor,    ///< symmetric, xx yy zz xy yz zx: mirrored
  matrix     ///< nine numbers, row by row: mirrored
};

/// Whole cache lines, so that a record of several numbers straddles none that it need not.
template <typename T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t line{64};
  CacheLineAllocator() = default;
  template <typename U>
  explicit CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, line); }
  bool operator==(const CacheLineAllocator&) const { return true; }
};
using ColumnValues = std::vector<double, CacheLineAllocator<double>>;

/// One array of the particles of this rank: those that it owns, then ghosts.
struct Column {
  std::string name;
  ColumnKind kind = ColumnKind::scalar;
  int components = 1;  ///< of a position or a vector: further ones are scalars that stand behind it
  bool kept = true;    ///< goes where its particle goes, and into checkpoints; what is not kept is found again
  bool saved = true;   ///< unless this says that a checkpoint is no place for it
  ColumnValues values;

  double* data() { return values.data(); }
  const double* data() const { return values.data(); }
  double& operator[](std::size_t i) { return values[i]; }
  double operator[](std::size_t i) const { return values[i]; }
  Vec3 vec(std::size_t i) const { return {values[3 * i], values[3 * i + 1], values[3 * i + 2]}; }
  void set(std::size_t i, const Vec3& v) { values[3 * i] = v[0], values[3 * i + 1] = v[1], values[3 * i + 2] = v[2]; }
};

/// All columns. The particles that this rank owns stand in canonical order (NeighbourLists), ghosts behind them.
class ParticleData {
  std::deque<Column> columns_;  // first: the references below are to its entries

 public:
  ParticleData() = default;
  ParticleData(const ParticleData&) = delete;
  ParticleData& operator=(const ParticleData&) = delete;

  /// A further column, zero at first; references stay valid. Before the first arrangement.
  Column& add(std::string name, ColumnKind kind, int components, bool kept);
  std::deque<Column>& columns() { return columns_; }
  const std::deque<Column>& columns() const { return columns_; }
  /// By name; nullptr if there is none.
  const Column* find(const std::string& name) const;

  std::size_t owned() const { return owned_; }
  std::size_t size() const { return ids.size(); }
  std::size_t ghosts() const { return size() - owned_; }
  /// All arrays get room for so many; what stands in the first ones stays.
  void resize(std::size_t owned, std::size_t ghosts);

  // What every particle has. At the time t(n) of the component:
  std::vector<GlobalId> ids;            ///< unique, the same on any number of ranks
  std::vector<std::int32_t> body;       ///< index in SphOptions::bodies
  std::vector<std::uint8_t> image;      ///< of ghosts: which copy (ParticleDomain); 0: the particle itself
  std::vector<std::int32_t> home_rank;  ///< where its node of the mesh is; of owned ones only
  std::vector<LocalIndex> home_node;

  Column& position = add("position", ColumnKind::position, 3, true);        ///< x(n), m
  Column& reference = add("reference", ColumnKind::position, 3, true);      ///< when the order was last chosen, m
  Column& velocity = add("velocity", ColumnKind::vector, 3, true);          ///< v(n-1/2), m/s
  Column& acceleration = add("acceleration", ColumnKind::vector, 3, true);  ///< a(n), of all forces, m/s^2
  Column& mass = add("mass", ColumnKind::scalar, 1, true);                  ///< kg (2-D: kg/m, 1-D: kg/m^2)
  Column& density = add("density", ColumnKind::scalar, 1, true);            ///< rho(n), kg/m^3
  Column& length = add("smoothing_length", ColumnKind::scalar, 1, true);    ///< h(n), m
  Column& reference_length = add("reference_length", ColumnKind::scalar, 1, true);  ///< with `reference`, m
  Column& former_velocity = add("former_velocity", ColumnKind::vector, 3, false);   ///< v(n-1/2), after the kick

 private:
  std::size_t owned_ = 0;
};

}  // namespace tenon
