// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/projection_rows.hpp"

#include <algorithm>
#include <memory>
#include <numeric>

namespace tenon::transfer {

namespace {

/// The source items that values come from, numbered in order of global id.
class Columns {
 public:
  Columns(const Side& source, const RowMap& interpolation, const TargetSamples& samples, const std::string& name)
      : by_node_(source.location == Location::node) {
    find_elements(source, samples, name);
    find_owners(source, interpolation);
    number(source, name);
    for (LocalIndex& slot : from_interpolation_) slot = column_[static_cast<std::size_t>(slot)];
    for (ElementColumns& element : elements_)
      for (std::size_t a = 0; a < element.count; ++a)
        element.column[a] = column_[static_cast<std::size_t>(element.column[a])];
  }

  struct ElementColumns {
    std::array<LocalIndex, max_nodes> column{};
    std::size_t count = 0;
  };
  const ElementColumns& of(const Sample& sample) {
    return elements_[static_cast<std::size_t>(element_table_.slot(sample.source_owner, sample.source_item))];
  }
  LocalIndex of_slot(std::size_t slot) const { return from_interpolation_[slot]; }
  bool by_node() const { return by_node_; }
  std::size_t size() const { return column_.size(); }
  ExchangePlan gather;

 private:
  /// The distinct source elements that samples lie in, and where their nodes are.
  void find_elements(const Side& source, const TargetSamples& samples, const std::string& name) {
    for (const Sample& s : samples.samples) element_table_.mark(s.source_owner, s.source_item);
    element_table_.number();
    elements_.resize(element_table_.owners().size());
    if (!by_node_) return;
    nodes_ = std::make_unique<PlacedNodes>(source.mesh, source.nodes, element_table_, name + ".elements");
  }

  /// Where the items of the interpolation are kept.
  void find_owners(const Side& source, const RowMap& interpolation) {
    std::vector<LocalIndex> here(source.items.ids.size());
    std::iota(here.begin(), here.end(), LocalIndex{0});
    owner_ = interpolation.gathered(source.items.owners);
    index_ = interpolation.gathered(std::span<const LocalIndex>(here));
  }

  void number(const Side& source, const std::string& name) {
    SlotTable table;
    for (std::size_t s = 0; s < owner_.size(); ++s) table.mark(owner_[s], index_[s]);
    for (std::size_t k = 0; by_node_ && k < nodes_->elements(); ++k) {
      const PlacedNodes::Nodes nodes = nodes_->element(k);
      for (std::size_t a = 0; a < nodes.count; ++a) table.mark(nodes.owner[a], nodes.at_owner[a]);
    }
    if (!by_node_)
      for (std::size_t k = 0; k < elements_.size(); ++k)
        table.mark(element_table_.owners()[k], element_table_.indices()[k]);
    table.number();
    for (std::size_t s = 0; s < owner_.size(); ++s) from_interpolation_.push_back(table.slot(owner_[s], index_[s]));
    for (std::size_t k = 0; k < elements_.size(); ++k) {
      elements_[k].count = by_node_ ? nodes_->element(k).count : 1;
      for (std::size_t a = 0; a < elements_[k].count; ++a)
        elements_[k].column[a] = by_node_ ? table.slot(nodes_->element(k).owner[a], nodes_->element(k).at_owner[a])
                                          : table.slot(element_table_.owners()[k], element_table_.indices()[k]);
    }
    nodes_.reset();
    order(source, table, name);
  }

  /// From slots, which ascend by owner, to columns, which ascend by id.
  void order(const Side& source, const SlotTable& table, const std::string& name) {
    const std::size_t count = table.owners().size();
    column_.resize(count);
    std::iota(column_.begin(), column_.end(), LocalIndex{0});
    const auto plan = [&](const std::string& suffix) {
      return ExchangePlan::from_owners(source.mesh.comm, table.owners(), table.indices(), column_, name + suffix);
    };
    std::vector<GlobalId> ids(count);
    plan(".ids").forward(source.items.ids, std::span<GlobalId>(ids));
    std::vector<LocalIndex> by_id(column_);
    std::sort(by_id.begin(), by_id.end(), [&](LocalIndex a, LocalIndex b) {
      return ids[static_cast<std::size_t>(a)] < ids[static_cast<std::size_t>(b)];
    });
    for (std::size_t k = 0; k < count; ++k) column_[static_cast<std::size_t>(by_id[k])] = static_cast<LocalIndex>(k);
    gather = plan(".gather");
  }

  bool by_node_;
  SlotTable element_table_;
  std::unique_ptr<PlacedNodes> nodes_;
  std::vector<ElementColumns> elements_;
  std::vector<int> owner_;
  std::vector<LocalIndex> index_, from_interpolation_, column_;
};

/// One row at a time, over all columns.
class Accumulator {
 public:
  explicit Accumulator(std::size_t columns) : value_(columns, 0.0), marked_(columns, 0) {}
  void add(LocalIndex column, double value) {
    const auto c = static_cast<std::size_t>(column);
    if (!marked_[c]) marked_[c] = 1, touched_.push_back(column);
    value_[c] += value;
  }
  /// Appends the row and begins the next one.
  void close(SparseRows& rows, double scale) {
    std::sort(touched_.begin(), touched_.end());
    for (const LocalIndex column : touched_) {
      const auto c = static_cast<std::size_t>(column);
      rows.column.push_back(column);
      rows.value.push_back(scale * value_[c]);
      value_[c] = 0, marked_[c] = 0;
    }
    rows.begin.push_back(static_cast<std::int64_t>(rows.column.size()));
    touched_.clear();
  }

 private:
  std::vector<double> value_;
  std::vector<char> marked_;
  std::vector<LocalIndex> touched_;
};

class Assembler {
 public:
  Assembler(const Side& source, const Side& target, const RowMap& interpolation, const TargetSamples& samples,
            SampleTables& tables, const std::string& name)
      : target_(target),
        interpolation_(interpolation),
        samples_(samples),
        tables_(tables),
        columns_(source, interpolation, samples, name),
        row_(columns_.size()) {}

  ProjectionRows to_nodes(const NodeElements& around, const MassMatrix& mass) {
    ProjectionRows result = begin();
    std::vector<double> of_node(static_cast<std::size_t>(target_.mesh.nodes()), 0.0);
    const std::vector<std::span<const LocalIndex>> nodes_of = connectivity();
    for (std::size_t k = 0; k < target_.mesh.owned_nodes.size(); ++k) {
      const LocalIndex i = target_.mesh.owned_nodes[k];
      add_interpolation(i, 1.0);
      row_.close(result.values, 1.0);
      for (const NodeElements::Entry& at : around.around(i)) {
        const auto nodes = nodes_of[static_cast<std::size_t>(at.element)];
        std::array<double, max_linear_nodes> part{};
        add_samples(at.element, [&](const Sample& s) {
          const double w = s.weight * s.target_value[static_cast<std::size_t>(at.place)];
          for (std::size_t b = 0; b < max_linear_nodes; ++b) part[b] += w * s.target_value[b];
          return w;
        });
        for (std::size_t b = 0; b < nodes.size(); ++b) of_node[static_cast<std::size_t>(nodes[b])] += part[b];
      }
      for (std::size_t m = mass.rows().first(k); m < mass.rows().last(k); ++m) {
        double& c = of_node[static_cast<std::size_t>(mass.rows().column[m])];
        if (c != 0) add_interpolation(mass.rows().column[m], -c);
        c = 0;
      }
      row_.close(result.residual, 1.0);
    }
    return result;
  }

  /// The mean over an element: that of the interpolated nodes, exactly, and of what the samples differ from it.
  ProjectionRows to_elements(std::span<const double> volumes) {
    ProjectionRows result = begin();
    for_each_element(target_.mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
      const Corners corners = corners_of(block, e, target_.coordinates);
      const auto nodes = block.nodes(e);
      std::array<double, max_nodes> part{};
      for (const TabulatedPoint& point : quadrature_points_of(block.kind)) {
        const double w = point.weight * measure(point, block.kind, corners);
        for (std::size_t b = 0; b < nodes.size(); ++b) part[b] += w * point.value[b];
      }
      add_samples(item, [&](const Sample& s) {
        for (std::size_t b = 0; b < max_linear_nodes; ++b) part[b] -= s.weight * s.target_value[b];
        return s.weight;
      });
      for (std::size_t b = 0; b < nodes.size(); ++b) add_interpolation(nodes[b], part[b]);
      const double volume = volumes[static_cast<std::size_t>(item)];
      row_.close(result.values, volume > 0 ? 1 / volume : 0.0);
    });
    return result;
  }

 private:
  ProjectionRows begin() {
    ProjectionRows result;
    result.gather = columns_.gather;
    result.columns = columns_.size();
    return result;
  }

  std::vector<std::span<const LocalIndex>> connectivity() const {
    std::vector<std::span<const LocalIndex>> result;
    result.reserve(static_cast<std::size_t>(target_.mesh.elements()));
    for_each_element(target_.mesh,
                     [&](LocalIndex, const ElementBlock& block, LocalIndex e) { result.push_back(block.nodes(e)); });
    return result;
  }

  const std::vector<TabulatedPoint>& quadrature_points_of(ElementKind kind) {
    std::vector<TabulatedPoint>& rule = rules_[static_cast<std::size_t>(kind)];
    if (rule.empty()) rule = quadrature_points(kind);
    return rule;
  }

  void add_interpolation(LocalIndex node, double factor) {
    interpolation_.for_each_term(static_cast<std::size_t>(node), [&](std::size_t slot, double weight) {
      if (weight != 0) row_.add(columns_.of_slot(slot), factor * weight);
    });
  }

  /// Adds sum_q weight(q) f(x_q) over the samples in an element.
  template <typename Weight>
  void add_samples(LocalIndex element, Weight&& weight) {
    const std::span<const Sample> samples = samples_.in(element);
    for (std::size_t q = 0; q < samples.size();) {
      const Sample& first = samples[q];
      const Columns::ElementColumns& columns = columns_.of(first);
      const std::vector<TabulatedPoint>& table = tables_.of(static_cast<ElementKind>(first.kind), first.cells);
      std::array<double, max_nodes> sum{};
      for (; q < samples.size() && samples[q].source_element == first.source_element; ++q) {
        const double w = weight(samples[q]);
        if (columns_.by_node()) {
          const std::array<double, max_nodes>& value = table[samples[q].point].value;
          for (std::size_t a = 0; a < columns.count; ++a) sum[a] += w * value[a];
        } else {
          sum[0] += w;
        }
      }
      for (std::size_t a = 0; a < columns.count; ++a) row_.add(columns.column[a], sum[a]);
    }
  }

  const Side& target_;
  const RowMap& interpolation_;
  const TargetSamples& samples_;
  SampleTables& tables_;
  Columns columns_;
  Accumulator row_;
  std::array<std::vector<TabulatedPoint>, element_kinds> rules_;
};

}  // namespace

ProjectionRows projection_rows(const Side& source, const Side& target, const RowMap& interpolation,
                               const TargetSamples& samples, SampleTables& tables, const NodeElements& around,
                               const MassMatrix& mass, std::span<const double> volumes, const std::string& name) {
  Assembler assembler(source, target, interpolation, samples, tables, name);
  return target.location == Location::node ? assembler.to_nodes(around, mass) : assembler.to_elements(volumes);
}

}  // namespace tenon::transfer
